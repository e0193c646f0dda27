// Acquisition: plays a recording as a sensor driver would publish it.
#include <depth_fusion/MapStatus.h>
#include <depth_fusion/TrackerStatus.h>
#include <pluginlib/class_list_macros.hpp>
#include <rosgraph_msgs/Clock.h>

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <sstream>
#include <thread>

#include "depth_fusion/common/percentile.h"
#include "depth_fusion/registration/frame_registration.h"
#include "ros/messages.h"
#include "ros/nodelets/shared_map.h"
#include "ros/nodelets/stage_nodelet.h"
#include "ros/recording.h"

namespace depth_fusion {
namespace {

constexpr double kLastFrames_s = 1.0;  // until the last ones are through
constexpr size_t kMaxLatencies = 100000;

}  // namespace

class AcquisitionNodelet : public StageNodelet {
 public:
  ~AcquisitionNodelet() override;

 private:
  void start() override;
  std::unique_ptr<Recording> open();
  // In the thread:
  void play();
  void playOnce();
  // Until everybody has connected who will.
  void awaitListeners();
  void awaitTime(double stamp_s);
  // Returns the stamp.
  ros::Time publish(const RgbdFrame& frame);
  // Until the frame is in the map, or lost; at most lossless_timeout_s.
  void awaitMap(const ros::Time& stamp);
  // False if stopping.
  bool sleep(double seconds);

  void noteDone(const ros::Time& stamp);
  void noteTracking(const TrackerStatus& status);
  // What has become of the frames so far.
  std::string summary();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  std::string recording_path_, camera_file_, frame_id_ = "camera_rgb_optical_frame";
  RecordingOptions options_;
  bool lossless_ = false, loop_ = false, restamp_ = false, publish_clock_ = false;
  float rate_ = 1.0f, lossless_timeout_s_ = 60.0f, settle_s_ = 1.0f;

  std::shared_ptr<ComputeContext> compute_;
  std::unique_ptr<Recording> recording_;
  ros::Publisher depth_publisher_, depth_info_publisher_, color_publisher_, color_info_publisher_, clock_publisher_;
  ros::Subscriber map_subscriber_, tracker_subscriber_;

  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::atomic<size_t> fused_{0}, lost_{0};
  std::vector<double> latencies_ms_;  // of the poses
  std::optional<ros::Time> done_;  // the frame of which was heard last that it is in the map, or lost
  std::string state_ = "waiting for subscribers";
  double first_stamp_s_ = -1.0;
  ros::WallTime first_sent_;
  std::thread thread_;
};

AcquisitionNodelet::~AcquisitionNodelet() {
  stopReporting();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void AcquisitionNodelet::start() {
  loadParameters(atStartOnly(
      {{"recording", &recording_path_, 0, 0, "a folder in the TUM or 7-Scenes layout, or a .bag file"},
       {"camera_file", &camera_file_, 0, 0, "camera file in place of the recording's; lens distortion is taken out"},
       {"depth_topic", &options_.depth_topic, 0, 0, "of a bag, instead of the one found"},
       {"color_topic", &options_.color_topic, 0, 0, "of a bag, instead of the one found"},
       {"frame_id", &frame_id_, 0, 0, "optical frame of the images"},
       {"rate", &rate_, 0.01, 100.0, "factor on the recording's speed"},
       {"loop", &loop_, 0, 1, "begin again at the end; the clock then jumps back"},
       {"restamp", &restamp_, 0, 1, "stamps of now, as a sensor's; false: the recording's"},
       {"publish_clock", &publish_clock_, 0, 1, "publish the stamps on /clock; for use_sim_time"},
       {"lossless", &lossless_, 0, 1, "the next frame waits until the one before is in the map, or lost"},
       {"lossless_timeout_s", &lossless_timeout_s_, 0.1, 3600.0, "how long it waits at most"},
       {"settle_s", &settle_s_, 0.0, 60.0, "begin when no subscriber has come or gone for so long"}}));
  check(!recording_path_.empty(), "give the parameter recording");
  if (!camera_file_.empty()) readCamera(camera_file_, options_);
  compute_ = sharedCompute("");
  recording_ = open();
  NODELET_INFO_STREAM(getName() << ": " << recording_->description());

  ros::NodeHandle& handle = getMTNodeHandle();
  depth_publisher_ = handle.advertise<sensor_msgs::Image>("depth/image", 10);
  depth_info_publisher_ = handle.advertise<sensor_msgs::CameraInfo>("depth/camera_info", 10);
  color_publisher_ = handle.advertise<sensor_msgs::Image>("rgb/image", 10);
  color_info_publisher_ = handle.advertise<sensor_msgs::CameraInfo>("rgb/camera_info", 10);
  if (publish_clock_) clock_publisher_ = handle.advertise<rosgraph_msgs::Clock>("/clock", 10);
  map_subscriber_ = handle.subscribe<MapStatus>(
      "tsdf_fusion/status", 100, [this](const MapStatus::ConstPtr& status) {
        if (status->fused && counter_.account().processed > 0) ++fused_;
        noteDone(status->header.stamp);
      });
  tracker_subscriber_ = handle.subscribe<TrackerStatus>(
      "icp_tracking/status", 100, [this](const TrackerStatus::ConstPtr& status) {
        noteTracking(*status);
        if (status->state >= TrackerStatus::LOST) noteDone(status->header.stamp);
      });
  startReporting();
  thread_ = std::thread([this] { play(); });
}

std::unique_ptr<Recording> AcquisitionNodelet::open() {
  RegistrationParameters parameters;
  parameters.depth_to_color = true;  // all images are in one frame
  return registered(openRecording(recording_path_, options_), *compute_, parameters);
}

void AcquisitionNodelet::play() {
  try {
    awaitListeners();
    do {
      if (recording_ == nullptr) recording_ = open();
      playOnce();
      recording_.reset();
    } while (loop_ && sleep(0.0));
    if (sleep(kLastFrames_s)) NODELET_INFO_STREAM(getName() << ": the recording has ended: " << summary());
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = "the recording has ended";
  } catch (const std::exception& error) {
    NODELET_ERROR_STREAM(getName() << ": " << error.what());
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = error.what();
  }
}

void AcquisitionNodelet::awaitListeners() {
  uint32_t known = 0;
  for (double quiet_s = 0.0; known == 0 || quiet_s < settle_s_; quiet_s += 0.1) {
    if (!sleep(0.1)) return;
    const uint32_t now = depth_publisher_.getNumSubscribers() + color_publisher_.getNumSubscribers() +
                         map_subscriber_.getNumPublishers() + tracker_subscriber_.getNumPublishers();
    if (depth_publisher_.getNumSubscribers() == 0 || now != known) quiet_s = 0.0;
    known = depth_publisher_.getNumSubscribers() == 0 ? 0 : now;
  }
}

void AcquisitionNodelet::playOnce() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_.clear();
    done_.reset();
    first_stamp_s_ = -1.0;
  }
  while (sleep(0.0)) {
    std::optional<RgbdFrame> frame;
    StageTimers timers;
    try {
      const StageTimers::Scope timer(timers, "recording/read");
      frame = recording_->next();
    } catch (const Error& error) {
      counter_.receive();
      counter_.drop("unreadable");
      NODELET_WARN_STREAM(getName() << ": " << error.what());
      continue;
    }
    if (!frame) return;
    counter_.receive();
    if (!lossless_) awaitTime(frame->stamp_s);
    ros::Time stamp;
    {
      const StageTimers::Scope timer(timers, "acquisition");
      stamp = publish(*frame);
    }
    counter_.process();
    recordTimings(timers);
    if (lossless_) awaitMap(stamp);
  }
}

void AcquisitionNodelet::awaitTime(double stamp_s) {
  if (first_stamp_s_ < 0.0) {
    first_stamp_s_ = stamp_s;
    first_sent_ = ros::WallTime::now();
  }
  sleep((stamp_s - first_stamp_s_) / rate_ - (ros::WallTime::now() - first_sent_).toSec());
}

ros::Time AcquisitionNodelet::publish(const RgbdFrame& frame) {
  const std_msgs::Header header = makeHeader(restamp_ ? ros::Time::now() : toRosTime(frame.stamp_s), frame_id_);
  if (publish_clock_) {
    rosgraph_msgs::Clock clock;
    clock.clock = header.stamp;
    clock_publisher_.publish(clock);
  }
  if (!frame.color.empty()) {
    color_info_publisher_.publish(boost::make_shared<sensor_msgs::CameraInfo>(makeCameraInfo(header, colorCamera(frame))));
    color_publisher_.publish(boost::make_shared<sensor_msgs::Image>(makeColorImage(header, frame.color)));
  }
  depth_info_publisher_.publish(boost::make_shared<sensor_msgs::CameraInfo>(makeCameraInfo(header, frame.intrinsics)));
  depth_publisher_.publish(boost::make_shared<sensor_msgs::Image>(makeDepthImage(header, frame.depth, frame.depth_unit_m)));
  return header.stamp;
}

void AcquisitionNodelet::awaitMap(const ros::Time& stamp) {
  std::unique_lock<std::mutex> lock(mutex_);
  const bool done = changed_.wait_for(lock, std::chrono::duration<double>(lossless_timeout_s_),
                                      [&] { return stopping_ || done_ == stamp; });
  if (done) return;
  NODELET_WARN_STREAM(getName() << ": nobody says what became of the frame of " << stamp << "; going on");
}

bool AcquisitionNodelet::sleep(double seconds) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(std::max(seconds, 0.0)), [this] { return stopping_; });
  return !stopping_;
}

void AcquisitionNodelet::noteDone(const ros::Time& stamp) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    done_ = stamp;
  }
  changed_.notify_all();
}

void AcquisitionNodelet::noteTracking(const TrackerStatus& status) {
  if (counter_.account().processed == 0) return;  // latched, of frames before
  if (status.state >= TrackerStatus::LOST) {
    ++lost_;
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (latencies_ms_.size() == kMaxLatencies) latencies_ms_.clear();
  latencies_ms_.push_back(1e3 * status.latency_s);
}

std::string AcquisitionNodelet::summary() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::ostringstream text;
  const size_t sent = counter_.account().processed;
  text << sent << " frames sent, " << fused_ << " fused, " << lost_ << " lost, " << sent - std::min(sent, fused_ + lost_) << " dropped";
  if (restamp_) {
    text << "; pose " << std::lround(percentile(latencies_ms_, 0.5)) << " ms after the image (median), "
         << std::lround(percentile(latencies_ms_, 0.95)) << " ms (95 %)";
  }
  return text.str();
}

void AcquisitionNodelet::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!state_.empty()) status.summary(diagnostic_msgs::DiagnosticStatus::OK, state_);
}

}  // namespace depth_fusion

PLUGINLIB_EXPORT_CLASS(depth_fusion::AcquisitionNodelet, nodelet::Nodelet)
