#include "ros/input/rgbd_subscriber.h"

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr double kMaxInfoWait_s = 0.5;  // for camera_info and tf
constexpr double kReleasePeriod_s = 0.02;
constexpr double kSilence_s = 2.0;  // without a depth image, before that is a problem

}  // namespace

RgbdSubscriber::RgbdSubscriber(ros::NodeHandle handle, const RgbdParameters& parameters,
                               const std::string& device, FrameCounter& counter, Callback callback)
    : depth_topic_(imageTopicName(handle, "depth/image", parameters.depth_transport)),
      color_topic_(imageTopicName(handle, "rgb/image", parameters.color_transport)),
      counter_(counter),
      callback_(std::move(callback)),
      cameras_(handle, depth_topic_, color_topic_),
      registration_(device),
      registration_parameters_(parameters.registration),
      pairing_(parameters.pairing),
      problem_("no depth image yet on " + depth_topic_ + "; is the sensor running, and is that its topic?"),
      color_(handle, color_topic_, parameters.color_transport,
             [this](const ImageMessage& image) { onColor(image); }),
      depth_(handle, depth_topic_, parameters.depth_transport,
             [this](const ImageMessage& image) { onDepth(image); }),
      timer_(callbacks_.createWallTimer(handle, ros::WallDuration(kReleasePeriod_s),
                                        [this](const ros::WallTimerEvent&) { deliverComplete(); })) {}

void RgbdSubscriber::setParameters(const RgbdParameters& parameters) {
  const std::lock_guard<std::mutex> lock(mutex_);
  pairing_.setParameters(parameters.pairing);
  registration_parameters_ = parameters.registration;
}

std::string RgbdSubscriber::problem() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const double silent_s = (ros::WallTime::now() - last_depth_).toSec();
  if (last_depth_.isZero() || silent_s < kSilence_s) return problem_;
  return "no depth image on " + depth_topic_ + " for " + std::to_string(static_cast<int>(silent_s)) +
         " s; is the sensor running?";
}

void RgbdSubscriber::onDepth(const ImageMessage& image) {
  counter_.receive();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_depth_ = ros::WallTime::now();
  }
  auto frame = std::make_shared<SensorFrame>();
  frame->header = image.header();
  if (!takeStamp(*frame)) return;
  try {
    const DepthImage depth = toDepth(image, depth_topic_);
    frame->rgbd.depth = depth.image;
    frame->rgbd.depth_unit_m = depth.unit_m;
    frame->depth_message = image.raw;
  } catch (const std::exception& error) {
    return drop("unusable depth image", error.what());
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    pairing_.addDepth(frame, ros::WallTime::now());
  }
  deliverComplete();
}

bool RgbdSubscriber::takeStamp(SensorFrame& frame) {
  ros::Time& stamp = frame.header.stamp;
  if (stamp.isZero())
    ROS_WARN_ONCE("%s: images without a stamp; they get the time of their arrival", depth_topic_.c_str());
  const StampPolicy::Verdict verdict = stamps_.judge(stamp, ros::Time::now());
  if (verdict.order == StampPolicy::Order::kOutOfOrder) {
    drop("out of order", depth_topic_ + ": an image is not later than the one before it");
    return false;
  }
  if (verdict.order == StampPolicy::Order::kClockJump) {
    ROS_WARN("%s: the clock went back by %.3f s", depth_topic_.c_str(), verdict.back_s);
    const std::lock_guard<std::mutex> lock(mutex_);
    for (size_t left = pairing_.restart(verdict.stamp); left > 0; --left) counter_.drop("clock jump");
  }
  stamp = verdict.stamp;
  frame.rgbd.stamp_s = stamp.toSec();
  frame.clock_jumps = verdict.clock_jumps;
  return true;
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
  turn_.wait(lock, [this] { return !delivering_; });
  delivering_ = true;
  // Gives the turn back, also when an exception ends it.
  const std::shared_ptr<void> end_of_turn(nullptr, [&](void*) {
    if (!lock.owns_lock()) lock.lock();
    delivering_ = false;
    turn_.notify_one();
  });
  while (const std::optional<RgbdPairing::Pair> pair = takeComplete()) {
    const RegistrationParameters registration = registration_parameters_;
    lock.unlock();
    deliver(*pair, registration);
    lock.lock();
  }
}

std::optional<RgbdPairing::Pair> RgbdSubscriber::takeComplete() {
  const SensorFrame* first = pairing_.first();
  if (first == nullptr) return std::nullopt;
  const ros::WallTime now = ros::WallTime::now();
  const bool complete = cameras_.areKnown(first->header) ? pairing_.firstIsComplete(now, color_.isPublished())
                                                         : pairing_.waited_s(now) > kMaxInfoWait_s;
  if (!complete) return std::nullopt;
  return pairing_.takeFirst();
}

void RgbdSubscriber::deliver(const RgbdPairing::Pair& pair, const RegistrationParameters& registration) {
  SensorFrame& frame = *pair.frame;
  try {
    if (!pair.color.empty()) decodeColor(frame, pair.color);
    const std::string color_frame = cameras_.describe(frame);
    checkColor(frame.rgbd);
    frame.rgbd = registration_.process(frame.rgbd, registration);
    const bool moved_to_color = !color_frame.empty() && !frame.rgbd.T_C_D;
    if (moved_to_color) frame.header.frame_id = color_frame;
  } catch (const std::exception& error) {
    return drop("unusable camera_info or tf", error.what());
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    problem_.clear();
  }
  callback_(pair.frame);
}

void RgbdSubscriber::decodeColor(SensorFrame& frame, const ImageMessage& image) const {
  try {
    frame.rgbd.color = toColor(image, color_topic_);
    frame.color_message = image.raw;
  } catch (const std::exception& error) {
    frame.rgbd.color_problem = error.what();
  }
}

void RgbdSubscriber::checkColor(RgbdFrame& frame) const {
  if (frame.color.empty() && frame.color_problem.empty()) return;
  frame.color_problem = colorProblem(frame);
  if (frame.color_problem.empty()) return;
  frame.color.release();
  ROS_WARN_THROTTLE(5.0, "%s: %s; only depth is used", color_topic_.c_str(), frame.color_problem.c_str());
}

void RgbdSubscriber::drop(const std::string& reason, const std::string& detail) {
  counter_.drop(reason);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    problem_ = detail;
  }
  ROS_WARN_THROTTLE(5.0, "a depth image is left out: %s", detail.c_str());
}

}  // namespace depth_fusion
