#include "ros/input/recording_player.h"

#include <rosgraph_msgs/Clock.h>

#include <cstdint>

#include "depth_fusion/common/error.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kLastFrames_s = 1.0;  // until the last ones are through

// All images in one frame.
RegistrationParameters ontoColor() {
  RegistrationParameters registration;
  registration.depth_to_color = true;
  return registration;
}

}  // namespace

RecordingPlayer::RecordingPlayer(const SourceHost& host, const PlayerParameters& parameters)
    : FrameSource(host), parameters_(parameters), registration_(parameters.device) {
  recording_ = open();
  ROS_INFO_STREAM(host_.name << ": " << recording_->description());
  ros::NodeHandle handle = host_.handle;
  depth_publisher_ = handle.advertise<sensor_msgs::Image>("depth/image", 10);
  depth_info_publisher_ = handle.advertise<sensor_msgs::CameraInfo>("depth/camera_info", 10);
  color_publisher_ = handle.advertise<sensor_msgs::Image>("rgb/image", 10);
  color_info_publisher_ = handle.advertise<sensor_msgs::CameraInfo>("rgb/camera_info", 10);
  if (parameters_.publish_clock) clock_publisher_ = handle.advertise<rosgraph_msgs::Clock>("/clock", 10);
  map_subscriber_ =
      handle.subscribe<MapStatus>("tsdf_fusion/status", 100, [this](const MapStatus::ConstPtr& status) {
        if (hasBegun()) summary_.noteMap(*status);
        noteDone(status->header.stamp);
      });
  tracker_subscriber_ = handle.subscribe<TrackerStatus>("icp_tracking/status", 100,
                                                        [this](const TrackerStatus::ConstPtr& status) {
                                                          if (hasBegun()) summary_.noteTracking(*status);
                                                          if (status->state >= TrackerStatus::LOST)
                                                            noteDone(status->header.stamp);
                                                        });
}

RecordingPlayer::~RecordingPlayer() {
  map_subscriber_.shutdown();
  tracker_subscriber_.shutdown();
}

std::unique_ptr<Recording> RecordingPlayer::open() const {
  RecordingOptions options;
  options.depth_topic = parameters_.depth_topic;
  options.color_topic = parameters_.color_topic;
  if (!parameters_.camera_file.empty()) readCamera(parameters_.camera_file, options);
  return openRecording(parameters_.recording, options);
}

void RecordingPlayer::run() {
  try {
    play();
  } catch (const std::exception& error) {
    setState(DiagnosticStatus::ERROR, error.what());
  }
}

void RecordingPlayer::play() {
  setState(DiagnosticStatus::OK, "waiting for subscribers");
  awaitListeners();
  do {
    if (recording_ == nullptr) recording_ = open();
    playOnce();
    recording_.reset();
  } while (parameters_.loop && sleep(0.0));
  if (sleep(kLastFrames_s))
    ROS_INFO_STREAM(host_.name << ": the recording has ended: "
                               << summary_.text(host_.counter.account().processed, parameters_.restamp));
  setState(DiagnosticStatus::OK, "the recording has ended");
}

void RecordingPlayer::awaitListeners() {
  uint32_t known = 0;
  for (double quiet_s = 0.0; known == 0 || quiet_s < parameters_.settle_s; quiet_s += 0.1) {
    if (!sleep(0.1)) return;
    const uint32_t now = depth_publisher_.getNumSubscribers() + color_publisher_.getNumSubscribers() +
                         map_subscriber_.getNumPublishers() + tracker_subscriber_.getNumPublishers();
    if (depth_publisher_.getNumSubscribers() == 0 || now != known) quiet_s = 0.0;
    known = depth_publisher_.getNumSubscribers() == 0 ? 0 : now;
  }
}

void RecordingPlayer::playOnce() {
  setState(DiagnosticStatus::OK, "");
  first_stamp_s_ = -1.0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    done_.reset();
  }
  while (sleep(0.0)) {
    std::optional<RgbdFrame> frame;
    StageTimers timers;
    try {
      const StageTimers::Scope timer(timers, "recording/read");
      frame = recording_->next();
    } catch (const Error& error) {
      host_.counter.receive();
      host_.counter.drop("unreadable");
      ROS_WARN_STREAM(host_.name << ": " << error.what());
      continue;
    }
    if (!frame) return;
    host_.counter.receive();
    if (!prepare(*frame)) continue;
    if (!parameters_.lossless) awaitTime(frame->stamp_s);
    ros::Time stamp;
    {
      const StageTimers::Scope timer(timers, "acquisition");
      stamp = publish(*frame);
    }
    host_.counter.process();
    host_.record_timings(timers);
    if (parameters_.lossless) awaitMap(stamp);
  }
}

bool RecordingPlayer::prepare(RgbdFrame& frame) {
  const std::string of_color = presentColorProblem(frame), &of_stamp = frame.stamp_problem;
  if (said_.isNew(of_color))
    setState(DiagnosticStatus::WARN,
             of_color + "; only the frame's depth is played, and so with others like it");
  if (said_.isNew(of_stamp.empty() ? "" : "stamps"))
    setState(DiagnosticStatus::WARN, of_stamp + ", and so with others like it");
  if (!of_color.empty()) frame.color.release();
  try {
    frame = registration_.process(frame, ontoColor());
    return true;
  } catch (const std::exception& error) {
    host_.counter.drop("not registered");
    setState(DiagnosticStatus::ERROR, error.what());
    return false;
  }
}

void RecordingPlayer::awaitTime(double stamp_s) {
  if (first_stamp_s_ < 0.0) {
    first_stamp_s_ = stamp_s;
    first_sent_ = ros::WallTime::now();
  }
  sleep((stamp_s - first_stamp_s_) / parameters_.rate - (ros::WallTime::now() - first_sent_).toSec());
}

ros::Time RecordingPlayer::publish(const RgbdFrame& frame) {
  const std_msgs::Header header =
      makeHeader(parameters_.restamp ? ros::Time::now() : toRosTime(frame.stamp_s), parameters_.frame_id);
  if (parameters_.publish_clock) {
    rosgraph_msgs::Clock clock;
    clock.clock = header.stamp;
    clock_publisher_.publish(clock);
  }
  if (!frame.color.empty()) {
    color_info_publisher_.publish(
        boost::make_shared<sensor_msgs::CameraInfo>(makeCameraInfo(header, colorCamera(frame))));
    color_publisher_.publish(boost::make_shared<sensor_msgs::Image>(makeColorImage(header, frame.color)));
  }
  depth_info_publisher_.publish(
      boost::make_shared<sensor_msgs::CameraInfo>(makeCameraInfo(header, frame.intrinsics)));
  depth_publisher_.publish(
      boost::make_shared<sensor_msgs::Image>(makeDepthImage(header, frame.depth, frame.depth_unit_m)));
  return header.stamp;
}

void RecordingPlayer::awaitMap(const ros::Time& stamp) {
  std::unique_lock<std::mutex> lock(mutex_);
  const bool done = changed_.wait_for(lock, std::chrono::duration<double>(parameters_.lossless_timeout_s),
                                      [&] { return stopping_ || done_ == stamp; });
  if (done) return;
  ROS_WARN_STREAM(host_.name << ": nobody says what became of the frame of " << stamp << "; going on");
}

void RecordingPlayer::noteDone(const ros::Time& stamp) {
  if (stamp.isZero()) return;  // of no frame
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    done_ = stamp;
  }
  changed_.notify_all();
}

}  // namespace depth_fusion
