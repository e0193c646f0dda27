#include "ros/input/rgbd_subscriber.h"

#include "depth_fusion/common/error.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr double kMaxInfoWait_s = 0.5;  // for camera_info and tf
constexpr double kReleasePeriod_s = 0.02;
constexpr double kLookPeriod_s = 1.0;

}  // namespace

RgbdSubscriber::RgbdSubscriber(ros::NodeHandle handle, const RgbdParameters& parameters,
                               const std::string& device, FrameCounter& counter, Callback callback)
    : counter_(counter),
      callback_(std::move(callback)),
      decoder_(handle, device),
      watch_(depth_, color_, decoder_.cameras()),
      parameters_(parameters),
      pairing_(parameters.pairing),
      body_(handle, parameters.masking),
      masks_(handle),
      color_(handle, "rgb/image", parameters.colorTransport(), ownColorTransports(),
             {[this](const ImageMessage& image) { onColor(image); }, [](uint32_t) {}, [] {}}),
      depth_(handle, "depth/image", parameters.depthTransport(), ownDepthTransports(),
             {[this](const ImageMessage& image) { onDepth(image); },
              [this](uint32_t images) { counter_.miss(images); },
              [this] {
                counter_.receive();
                counter_.drop("another publisher");
              }}),
      release_timer_(callbacks_.createWallTimer(handle, ros::WallDuration(kReleasePeriod_s),
                                                [this](const ros::WallTimerEvent&) { deliverComplete(); })),
      look_timer_(callbacks_.createWallTimer(handle, ros::WallDuration(kLookPeriod_s),
                                             [this](const ros::WallTimerEvent&) { watch_.look(); })) {}

void RgbdSubscriber::setParameters(const RgbdParameters& parameters) {
  body_.setParameters(parameters.masking);
  const std::lock_guard<std::mutex> lock(mutex_);
  pairing_.setParameters(parameters.pairing);
  parameters_ = parameters;
}

void RgbdSubscriber::onDepth(const ImageMessage& image) {
  counter_.receive();
  auto messages = std::make_shared<RgbdMessages>();
  messages->depth = image;
  messages->header = image.header();
  messages->header.frame_id = withoutSlash(messages->header.frame_id);
  messages->received = ros::WallTime::now();
  messages->depth_topic = depth_.name();
  messages->color_topic = color_.name();
  watch_.noteDepth();
  if (!takeStamp(*messages)) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    pairing_.addDepth(messages);
  }
  deliverComplete();
}

bool RgbdSubscriber::takeStamp(RgbdMessages& messages) {
  ros::Time& stamp = messages.header.stamp;
  const StampPolicy::Verdict verdict = stamps_.judge(stamp, ros::Time::now());
  const std::string topic = depth_.name();
  if (verdict.stamp != stamp)
    ROS_WARN_ONCE("%s: images without a stamp of their own; they get the time of their arrival",
                  topic.c_str());
  switch (verdict.order) {
    case StampPolicy::Order::kOutOfOrder:
      drop("out of order", topic + ": an image is not later than the one before it");
      return false;
    case StampPolicy::Order::kDoubtful:
      drop("doubtful stamp", topic + ": the stamp of an image is " + std::to_string(verdict.off_s) +
                                 " s off from the one before it, and neither ROS time nor other images are");
      return false;
    case StampPolicy::Order::kClockJump:
      restart(verdict);
      break;
    case StampPolicy::Order::kNext:
      break;
  }
  stamp = verdict.stamp;
  messages.clock_jumps = verdict.clock_jumps;
  return true;
}

void RgbdSubscriber::restart(const StampPolicy::Verdict& jump) {
  ROS_WARN("%s: the clock went back by %.3f s, %s", depth_.name().c_str(), -jump.off_s, jump.reason.c_str());
  const std::lock_guard<std::mutex> lock(mutex_);
  for (size_t left = pairing_.restart(jump.stamp); left > 0; --left) counter_.drop("clock jump");
}

void RgbdSubscriber::onColor(const ImageMessage& image) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    pairing_.addColor(stampOrArrival(image.header().stamp, ros::Time::now()), image);
  }
  deliverComplete();
}

void RgbdSubscriber::deliverComplete() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (delivering_) return;
  delivering_ = true;
  while (const RgbdMessagesPtr messages = takeComplete()) {
    lock.unlock();
    if (messages->mask == nullptr && masks_.isPublished()) {
      drop("no mask",
           masks_.name() + " is published, and has no mask of the image's stamp; see masking/max_wait_s");
    } else {
      callback_(messages);
    }
    lock.lock();
  }
  delivering_ = false;
}

RgbdMessagesPtr RgbdSubscriber::takeComplete() {
  const RgbdMessages* first = pairing_.first();
  return first != nullptr && isComplete(*first) ? withMask(pairing_.takeFirst()) : nullptr;
}

bool RgbdSubscriber::isComplete(const RgbdMessages& first) {
  const ros::WallTime now = ros::WallTime::now();
  const double waited_s = pairing_.waited_s(now);
  const bool are_known = decoder_.knowsCameras(first);
  const bool waited_in_vain = !are_known && waited_s > kMaxInfoWait_s;
  awaits_cameras_ = (awaits_cameras_ || are_known) && !waited_in_vain;
  if (!are_known && awaits_cameras_) return false;
  if (!pairing_.firstIsComplete(now, color_.isPublished())) return false;
  if (waited_s > parameters_.masking.max_wait_s) return true;
  const ros::Time& stamp = first.depth.header().stamp;
  const bool mask_comes = masks_.isPublished() && !masks_.isPast(stamp) &&
                          masks_.find(stamp, parameters_.pairing.max_gap_s) == nullptr;
  return !mask_comes && body_.isKnown(first.header);
}

RgbdMessagesPtr RgbdSubscriber::withMask(const RgbdMessagesPtr& messages) const {
  const sensor_msgs::ImageConstPtr mask =
      masks_.find(messages->depth.header().stamp, parameters_.pairing.max_gap_s);
  if (mask == nullptr) return messages;
  auto masked = std::make_shared<RgbdMessages>(*messages);
  masked->mask = mask;
  return masked;
}

SensorFramePtr RgbdSubscriber::decode(const RgbdMessages& messages) {
  RegistrationParameters registration;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    registration = parameters_.registration;
  }
  try {
    const SensorFramePtr frame = body_.withoutBody(decoder_.decode(messages, registration));
    const std::string& color_problem = frame->rgbd.color_problem;
    if (said_of_color_.isNew(color_problem)) ROS_WARN_STREAM(color_problem << "; only depth is used");
    const std::lock_guard<std::mutex> lock(mutex_);
    problem_.clear();
    color_problem_ = color_problem;
    return frame;
  } catch (const std::exception& error) {
    drop("unusable image or camera_info", error.what());
    return nullptr;
  }
}

void RgbdSubscriber::drop(const std::string& reason, const std::string& detail) {
  counter_.drop(reason);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    problem_ = detail;
  }
  ROS_WARN_THROTTLE(5.0, "a depth image is left out: %s", detail.c_str());
}

std::string RgbdSubscriber::problem() const {
  const std::string silence = watch_.silence(), publishers = watch_.publishers();
  if (!silence.empty()) return silence;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!problem_.empty()) return problem_;
  return publishers.empty() ? color_problem_ : publishers;
}

}  // namespace depth_fusion
