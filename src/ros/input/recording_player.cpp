#include "ros/input/recording_player.h"

#include <rosgraph_msgs/Clock.h>

#include <cmath>
#include <sstream>

#include "depth_fusion/common/error.h"
#include "depth_fusion/common/percentile.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kLastFrames_s = 1.0;  // until the last ones are through
constexpr size_t kMaxLatencies = 100000;

// All images in one frame.
RegistrationParameters ontoColor() {
  RegistrationParameters registration;
  registration.depth_to_color = true;
  return registration;
}

}  // namespace

ParameterTable PlayerParameters::table() {
  return atStartOnly(
      {{"recording", &recording, 0, 0, "a folder in the TUM or 7-Scenes layout, or a .bag or .oni file"},
       {"camera_file", &camera_file, 0, 0,
        "camera file in place of the recording's; lens distortion is taken out"},
       {"depth_topic", &options.depth_topic, 0, 0, "of a bag, instead of the one found"},
       {"color_topic", &options.color_topic, 0, 0, "of a bag, instead of the one found"},
       {"device", &device, 0, 0,
        "OpenCL device, as of icp_tracking; opened where depth is to be moved or a lens undistorted"},
       {"frame_id", &frame_id, 0, 0, "optical frame of a recording's images"},
       {"rate", &rate, 0.01, 100.0, "factor on the recording's speed"},
       {"loop", &loop, 0, 1, "begin again at the end; the clock then jumps back"},
       {"restamp", &restamp, 0, 1, "stamps of now, as a sensor's; false: the recording's"},
       {"publish_clock", &publish_clock, 0, 1, "publish the stamps on /clock; for use_sim_time"},
       {"lossless", &lossless, 0, 1, "the next frame waits until the one before is in the map, or lost"},
       {"lossless_timeout_s", &lossless_timeout_s, 0.1, 3600.0, "how long it waits at most"},
       {"settle_s", &settle_s, 0.0, 60.0, "begin when no subscriber has come or gone for so long"}});
}

RecordingPlayer::RecordingPlayer(const SourceHost& host, const PlayerParameters& parameters)
    : FrameSource(host), parameters_(parameters), registration_(parameters.device, ontoColor()) {
  if (!parameters_.camera_file.empty()) readCamera(parameters_.camera_file, parameters_.options);
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
        if (status->fused && host_.counter.account().processed > 0) ++fused_;
        noteDone(status->header.stamp);
      });
  tracker_subscriber_ = handle.subscribe<TrackerStatus>("icp_tracking/status", 100,
                                                        [this](const TrackerStatus::ConstPtr& status) {
                                                          noteTracking(*status);
                                                          if (status->state >= TrackerStatus::LOST)
                                                            noteDone(status->header.stamp);
                                                        });
}

RecordingPlayer::~RecordingPlayer() {
  map_subscriber_.shutdown();
  tracker_subscriber_.shutdown();
}

std::unique_ptr<Recording> RecordingPlayer::open() const {
  return openRecording(parameters_.recording, parameters_.options);
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
  if (sleep(kLastFrames_s)) ROS_INFO_STREAM(host_.name << ": the recording has ended: " << summary());
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
    frame = registration_.process(*frame);
    host_.counter.receive();
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

void RecordingPlayer::noteTracking(const TrackerStatus& status) {
  if (host_.counter.account().processed == 0) return;  // latched, of frames before
  if (status.state >= TrackerStatus::LOST) {
    ++lost_;
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (latencies_ms_.size() == kMaxLatencies) latencies_ms_.clear();
  latencies_ms_.push_back(1e3 * status.latency_s);
}

std::string RecordingPlayer::summary() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::ostringstream text;
  const size_t sent = host_.counter.account().processed;
  text << sent << " frames sent, " << fused_ << " fused, " << lost_ << " lost, "
       << sent - std::min(sent, fused_ + lost_) << " dropped";
  if (parameters_.restamp) {
    text << "; pose " << std::lround(percentile(latencies_ms_, 0.5)) << " ms after the image (median), "
         << std::lround(percentile(latencies_ms_, 0.95)) << " ms (95 %)";
  }
  return text.str();
}

}  // namespace depth_fusion
