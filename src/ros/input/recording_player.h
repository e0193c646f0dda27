// Plays a recording as a sensor driver would publish it.
#pragma once

#include <optional>

#include "ros/bags/open_recording.h"
#include "ros/input/frame_source.h"
#include "ros/input/lazy_registration.h"
#include "ros/input/playback_summary.h"
#include "ros/input/player_parameters.h"
#include "ros/input/said_once.h"

namespace depth_fusion {

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
  // Says what is wrong with the frame, and makes it one camera's. False if that cannot be done.
  bool prepare(RgbdFrame& frame);
  // Waits until everybody has connected who will.
  void awaitListeners();
  void awaitTime(double stamp_s);
  // Returns the stamp that the frame went out with.
  ros::Time publish(const RgbdFrame& frame);
  // Waits until the frame is in the map, or lost; at most lossless_timeout_s.
  void awaitMap(const ros::Time& stamp);

  // False as long as what is heard is of frames before.
  bool hasBegun() const { return host_.counter.account().processed > 0; }
  void noteDone(const ros::Time& stamp);

  PlayerParameters parameters_;
  LazyRegistration registration_;
  std::unique_ptr<Recording> recording_;
  ros::Publisher depth_publisher_, depth_info_publisher_, color_publisher_, color_info_publisher_,
      clock_publisher_;
  ros::Subscriber map_subscriber_, tracker_subscriber_;

  PlaybackSummary summary_;
  SaidOnce said_;                  // of frames
  std::optional<ros::Time> done_;  // the frame of which was heard last that it is in the map, or lost
  double first_stamp_s_ = -1.0;
  ros::WallTime first_sent_;
};

}  // namespace depth_fusion
