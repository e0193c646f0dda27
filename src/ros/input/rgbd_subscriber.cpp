#include "ros/input/rgbd_subscriber.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/common/error.h"
#include "ros/conversions/image_conversions.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kTopicQueue = 30;
constexpr size_t kColorsKept = 30;
// Stamps that go back by less are images out of order, by more a clock that was set back.
constexpr double kClockJump_s = 1.0;
constexpr double kMaxInfoWait_s = 0.5;  // for camera_info and tf
constexpr double kReleasePeriod_s = 0.02;
constexpr double kSilence_s = 2.0;  // without a depth image, before that is a problem

}  // namespace

ParameterTable RgbdParameters::table() {
  return {{"depth_transport",
           &depth_transport,
           0,
           0,
           "of depth/image",
           {"raw", "compressedDepth", "compressed"},
           true},
          {"color_transport", &color_transport, 0, 0, "of rgb/image", {"raw", "compressed"}, true},
          {"max_pairing_gap_s", &max_pairing_gap_s, 0.0, 1.0,
           "colour farther from its depth than this is left out"},
          {"max_color_wait_s", &max_color_wait_s, 0.0, 10.0, "how long a depth image waits for its colour"}};
}

RgbdSubscriber::RgbdSubscriber(ros::NodeHandle handle, const RgbdParameters& parameters,
                               const std::string& device, FrameCounter& counter, Callback callback)
    : handle_(handle),
      parameters_(parameters),
      registration_(device, parameters.registration),
      counter_(counter),
      callback_(std::move(callback)) {
  const std::lock_guard<std::mutex> lock(mutex_);
  subscribe(handle);
  problem_ = "no depth image yet on " + depth_topic_ + "; is the sensor running, and is that its topic?";
  timer_ = handle.createWallTimer(ros::WallDuration(kReleasePeriod_s), [this](const ros::WallTimerEvent&) {
    const std::lock_guard<std::mutex> timer_lock(mutex_);
    release();
  });
}

RgbdSubscriber::~RgbdSubscriber() {
  timer_.stop();
  for (ros::Subscriber* subscriber :
       {&depth_subscriber_, &color_subscriber_, &depth_info_subscriber_, &color_info_subscriber_})
    subscriber->shutdown();
}

void RgbdSubscriber::subscribe(ros::NodeHandle& handle) {
  using sensor_msgs::CameraInfoConstPtr;
  using sensor_msgs::CompressedImageConstPtr;
  using sensor_msgs::ImageConstPtr;
  const auto topic = [&](const std::string& image, const std::string& transport) {
    return handle.resolveName(image) + (transport == "raw" ? "" : "/" + transport);
  };
  depth_topic_ = topic("depth/image", parameters_.depth_transport);
  color_topic_ = topic("rgb/image", parameters_.color_transport);
  info_topic_ = handle.resolveName("depth/camera_info");
  depth_info_subscriber_ = handle.subscribe<sensor_msgs::CameraInfo>(
      "depth/camera_info", kTopicQueue, [this](const CameraInfoConstPtr& info) {
        const std::lock_guard<std::mutex> lock(mutex_);
        depth_info_ = info;
      });
  color_info_subscriber_ = handle.subscribe<sensor_msgs::CameraInfo>(
      "rgb/camera_info", kTopicQueue, [this](const CameraInfoConstPtr& info) {
        const std::lock_guard<std::mutex> lock(mutex_);
        color_info_ = info;
      });
  const auto take = [](SensorFrame& frame, const DepthImage& depth) {
    frame.rgbd.depth = depth.image;
    frame.rgbd.depth_unit_m = depth.unit_m;
  };
  if (parameters_.depth_transport == "raw") {
    depth_subscriber_ = handle.subscribe<sensor_msgs::Image>(
        depth_topic_, kTopicQueue, [this, take](const ImageConstPtr& image) {
          onDepth(image->header, [&](SensorFrame& frame) {
            take(frame, depthFromImage(*image, depth_topic_));
            frame.depth_message = image;
          });
        });
  } else {
    depth_subscriber_ = handle.subscribe<sensor_msgs::CompressedImage>(
        depth_topic_, kTopicQueue, [this, take](const CompressedImageConstPtr& image) {
          onDepth(image->header,
                  [&](SensorFrame& frame) { take(frame, depthFromCompressed(*image, depth_topic_)); });
        });
  }
  if (parameters_.color_transport == "raw") {
    color_subscriber_ =
        handle.subscribe<sensor_msgs::Image>(color_topic_, kTopicQueue, [this](const ImageConstPtr& image) {
          onColor({image->header, image, nullptr});
        });
  } else {
    color_subscriber_ = handle.subscribe<sensor_msgs::CompressedImage>(
        color_topic_, kTopicQueue, [this](const CompressedImageConstPtr& image) {
          onColor({image->header, nullptr, image});
        });
  }
}

void RgbdSubscriber::setParameters(const RgbdParameters& parameters) {
  const std::lock_guard<std::mutex> lock(mutex_);
  parameters_ = parameters;
  registration_.setParameters(parameters.registration);
}

std::string RgbdSubscriber::problem() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const double silent_s = (ros::WallTime::now() - last_depth_).toSec();
  if (last_depth_.isZero() || silent_s < kSilence_s) return problem_;
  return "no depth image on " + depth_topic_ + " for " + std::to_string(static_cast<int>(silent_s)) +
         " s; is the sensor running?";
}

void RgbdSubscriber::onDepth(const std_msgs::Header& header,
                             const std::function<void(SensorFrame&)>& decode) {
  const std::lock_guard<std::mutex> lock(mutex_);
  counter_.receive();
  last_depth_ = ros::WallTime::now();
  auto frame = std::make_shared<SensorFrame>();
  frame->header = header;
  if (!takeStamp(*frame)) return;
  try {
    decode(*frame);
  } catch (const std::exception& error) {
    return drop("unusable depth image", error.what());
  }
  pending_.push_back({frame, ros::WallTime::now()});
  release();
}

bool RgbdSubscriber::takeStamp(SensorFrame& frame) {
  ros::Time& stamp = frame.header.stamp;
  if (stamp.isZero()) {
    ROS_WARN_ONCE("%s: images without a stamp; they get the time of their arrival", depth_topic_.c_str());
    stamp = ros::Time::now();
  }
  if (last_stamp_ && stamp <= *last_stamp_) {
    if ((*last_stamp_ - stamp).toSec() < kClockJump_s) {
      drop("out of order", depth_topic_ + ": an image is not later than the one before it");
      return false;
    }
    ROS_WARN("%s: the clock went back by %.3f s", depth_topic_.c_str(), (*last_stamp_ - stamp).toSec());
    ++clock_jumps_;
    for (size_t i = 0; i < pending_.size(); ++i) counter_.drop("clock jump");
    pending_.clear();
    const ros::Time future = stamp + ros::Duration(kClockJump_s);
    colors_.erase(std::remove_if(colors_.begin(), colors_.end(),
                                 [&](const ColorImage& color) { return color.header.stamp > future; }),
                  colors_.end());
  }
  last_stamp_ = stamp;
  frame.rgbd.stamp_s = stamp.toSec();
  frame.clock_jumps = clock_jumps_;
  return true;
}

void RgbdSubscriber::takeCamera(SensorFrame& frame) const {
  check(depth_info_ != nullptr,
        "no camera_info yet on " + info_topic_ + "; remap depth/camera_info to the driver's");
  const CameraIntrinsics camera = cameraFromInfo(*depth_info_, depth_topic_);
  check(camera.valid(), info_topic_ + ": no focal length or size; calibrate the camera (camera_calibration)");
  check(camera.width == frame.rgbd.depth.cols && camera.height == frame.rgbd.depth.rows,
        info_topic_ + " is for " + sizeText(camera.width, camera.height) + ", " + depth_topic_ + " is " +
            sizeText(frame.rgbd.depth.cols, frame.rgbd.depth.rows));
  frame.rgbd.intrinsics = camera;
  frame.rgbd.distortion = frame.rgbd.color_distortion = distortionFromInfo(*depth_info_, depth_topic_);
}

void RgbdSubscriber::takeColorCamera(SensorFrame& frame) const {
  if (color_info_ == nullptr) return;
  const CameraIntrinsics camera = cameraFromInfo(*color_info_, color_topic_);
  if (!camera.valid()) return;
  if (!sameCamera(camera, frame.rgbd.intrinsics)) frame.rgbd.color_intrinsics = camera;
  frame.rgbd.color_distortion = distortionFromInfo(*color_info_, color_topic_);
  const std::string color_frame = otherColorFrame(frame.header);
  if (!color_frame.empty()) frame.rgbd.T_C_D = lookUpColorCamera(color_frame, frame.header.frame_id);
}

std::string RgbdSubscriber::otherColorFrame(const std_msgs::Header& depth) const {
  if (color_info_ == nullptr || depth.frame_id.empty() || color_info_->header.frame_id == depth.frame_id)
    return "";
  return color_info_->header.frame_id;
}

Pose RgbdSubscriber::lookUpColorCamera(const std::string& color_frame, const std::string& depth_frame) const {
  try {
    return fromMessage(tf_->lookupTransform(color_frame, depth_frame, ros::Time(0)).transform);
  } catch (const tf2::TransformException&) {
    throw Error("depth is in the frame " + depth_frame + ", colour in " + color_frame +
                ", and tf does not connect them; publish where the cameras are (rosrun tf2_ros "
                "static_transform_publisher X Y Z YAW PITCH ROLL " +
                color_frame + " " + depth_frame + "), or let the driver register depth to colour");
  }
}

bool RgbdSubscriber::knowsCameras(const std_msgs::Header& depth) {
  if (depth_info_ == nullptr) return false;
  const std::string color_frame = otherColorFrame(depth);
  if (color_frame.empty()) return true;
  if (tf_ == nullptr) {
    tf_ = std::make_unique<tf2_ros::Buffer>();
    tf_listener_ = std::make_unique<tf2_ros::TransformListener>(*tf_, handle_);
  }
  return tf_->canTransform(color_frame, depth.frame_id, ros::Time(0));
}

void RgbdSubscriber::registerFrame(SensorFrame& frame) {
  const bool was_beside = frame.rgbd.T_C_D.has_value();
  frame.rgbd = registration_.process(frame.rgbd);
  if (was_beside && !frame.rgbd.T_C_D) frame.header.frame_id = color_info_->header.frame_id;
}

void RgbdSubscriber::onColor(ColorImage color) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (color.header.stamp.isZero()) color.header.stamp = ros::Time::now();
  colors_.push_back(std::move(color));
  if (colors_.size() > kColorsKept) colors_.pop_front();
  release();
}

void RgbdSubscriber::release() {
  while (!pending_.empty() && isComplete(pending_.front())) {
    const std::shared_ptr<SensorFrame> frame = pending_.front().frame;
    pending_.pop_front();
    try {
      takeCamera(*frame);
      takeColorCamera(*frame);
      addColor(*frame);
      registerFrame(*frame);
    } catch (const std::exception& error) {
      drop("unusable camera_info or tf", error.what());
      continue;
    }
    problem_.clear();
    callback_(frame);
  }
}

bool RgbdSubscriber::isComplete(const PendingDepth& depth) {
  const double waited_s = (ros::WallTime::now() - depth.received).toSec();
  if (!knowsCameras(depth.frame->header)) return waited_s > kMaxInfoWait_s;
  if (color_subscriber_.getNumPublishers() == 0 && colors_.empty()) return true;
  for (const ColorImage& color : colors_) {
    if (color.header.stamp >= depth.frame->header.stamp) return true;
  }
  return waited_s > parameters_.max_color_wait_s;
}

const RgbdSubscriber::ColorImage* RgbdSubscriber::nearestColor(const ros::Time& stamp) const {
  const ColorImage* nearest = nullptr;
  double nearest_gap_s = parameters_.max_pairing_gap_s;
  for (const ColorImage& color : colors_) {
    const double gap_s = std::abs((color.header.stamp - stamp).toSec());
    if (gap_s > nearest_gap_s || (nearest != nullptr && gap_s == nearest_gap_s)) continue;
    nearest = &color;
    nearest_gap_s = gap_s;
  }
  return nearest;
}

void RgbdSubscriber::addColor(SensorFrame& frame) {
  const ColorImage* color = nearestColor(frame.header.stamp);
  if (color == nullptr) return;
  try {
    frame.rgbd.color = color->raw ? colorFromImage(*color->raw, color_topic_)
                                  : colorFromCompressed(*color->compressed, color_topic_);
    frame.color_message = color->raw;
    const std::string problem = colorProblem(frame.rgbd);
    check(problem.empty(), color_topic_ + ": " + problem);
  } catch (const std::exception& error) {
    frame.rgbd.color.release();
    frame.rgbd.color_problem = error.what();
    ROS_WARN_THROTTLE(5.0, "%s; only depth is used", error.what());
  }
}

void RgbdSubscriber::drop(const std::string& reason, const std::string& detail) {
  counter_.drop(reason);
  problem_ = detail;
  ROS_WARN_THROTTLE(5.0, "a depth image is left out: %s", detail.c_str());
}

}  // namespace depth_fusion
