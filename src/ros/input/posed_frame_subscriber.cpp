#include "ros/input/posed_frame_subscriber.h"

#include "ros/conversions/messages.h"

namespace depth_fusion {

PosedFrameSubscriber::PosedFrameSubscriber(ros::NodeHandle handle, const RgbdParameters& rgbd,
                                           const std::string& device, const std::string& map_frame,
                                           int queue_size, FrameCounter& counter, Callback callback)
    : map_frame_(map_frame), counter_(counter), callback_(std::move(callback)) {
  listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_, handle);
  filter_ = std::make_unique<tf2_ros::MessageFilter<Message>>(buffer_, map_frame_, queue_size, handle);
  filter_->registerCallback(boost::function<void(const Message::ConstPtr&)>([this](const auto& message) {
    callback_(Deferred<TrackedFrame>([this, messages = message->payload] { return decode(*messages); }));
  }));
  filter_->registerFailureCallback(
      [this](const Message::ConstPtr& message, tf2_ros::filter_failure_reasons::FilterFailureReason) {
        std::string why;
        buffer_.canTransform(map_frame_, message->header.frame_id, message->header.stamp, &why);
        drop(why);
      });
  sensor_ = std::make_unique<RgbdSubscriber>(
      handle, rgbd, device, counter_, [this](const RgbdMessagesPtr& messages) {
        filter_->add(makeMessage<RgbdMessages>(messages->header, messages));
      });
}

PosedFrameSubscriber::~PosedFrameSubscriber() {
  sensor_.reset();
  listener_.reset();
  filter_.reset();
}

std::string PosedFrameSubscriber::problem() const {
  const std::string of_sensor = sensor_->problem();
  const std::lock_guard<std::mutex> lock(mutex_);
  return of_sensor.empty() ? problem_ : of_sensor;
}

TrackedFramePtr PosedFrameSubscriber::decode(const RgbdMessages& messages) {
  auto frame = std::make_shared<TrackedFrame>();
  frame->sensor = sensor_->decode(messages);
  if (frame->sensor == nullptr) return nullptr;
  const std_msgs::Header& camera = frame->sensor->header;  // the colour camera's, if depth was moved there
  frame->tracking.status = TrackingStatus::kTracking;
  try {
    frame->tracking.T_W_D =
        fromMessage(buffer_.lookupTransform(map_frame_, camera.frame_id, camera.stamp).transform);
  } catch (const tf2::TransformException& error) {
    drop(error.what());
    return nullptr;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  problem_.clear();
  return frame;
}

void PosedFrameSubscriber::drop(const std::string& why) {
  counter_.drop("no pose on tf");
  ROS_WARN_THROTTLE(5.0, "a frame has no pose on tf: %s", why.c_str());
  const std::lock_guard<std::mutex> lock(mutex_);
  problem_ = "no pose on tf: " + why;
}

}  // namespace depth_fusion
