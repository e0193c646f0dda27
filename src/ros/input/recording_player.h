// Plays a recording as a sensor driver would publish it.
#pragma once

#include <depth_fusion/MapStatus.h>
#include <depth_fusion/TrackerStatus.h>

#include <atomic>
#include <optional>
#include <vector>

#include "depth_fusion/common/parameters.h"
#include "ros/input/frame_source.h"
#include "ros/input/lazy_registration.h"
#include "ros/bags/open_recording.h"

namespace depth_fusion {

struct PlayerParameters {
  std::string recording, camera_file, device, frame_id = "camera_rgb_optical_frame";
  RecordingOptions options;
  bool lossless = false, loop = false, restamp = false, publish_clock = false;
  float rate = 1.0f, lossless_timeout_s = 60.0f, settle_s = 1.0f;

  ParameterTable table();
};

class RecordingPlayer : public FrameSource {
 public:
  // Throws Error if the recording cannot be read.
  RecordingPlayer(const SourceHost& host, const PlayerParameters& parameters);
  ~RecordingPlayer() override;

  void run() override;

 private:
  std::unique_ptr<Recording> open() const;
  void play();
  void playOnce();
  // Until everybody has connected who will.
  void awaitListeners();
  void awaitTime(double stamp_s);
  // Returns the stamp.
  ros::Time publish(const RgbdFrame& frame);
  // Until the frame is in the map, or lost; at most lossless_timeout_s.
  void awaitMap(const ros::Time& stamp);

  void noteDone(const ros::Time& stamp);
  void noteTracking(const TrackerStatus& status);
  // What has become of the frames so far.
  std::string summary();

  PlayerParameters parameters_;
  LazyRegistration registration_;
  std::unique_ptr<Recording> recording_;
  ros::Publisher depth_publisher_, depth_info_publisher_, color_publisher_, color_info_publisher_,
      clock_publisher_;
  ros::Subscriber map_subscriber_, tracker_subscriber_;

  std::atomic<size_t> fused_{0}, lost_{0};
  std::vector<double> latencies_ms_;  // of the poses
  std::optional<ros::Time> done_;     // the frame of which was heard last that it is in the map, or lost
  double first_stamp_s_ = -1.0;
  ros::WallTime first_sent_;
};

}  // namespace depth_fusion
