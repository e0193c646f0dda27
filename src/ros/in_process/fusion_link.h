// The tracker's line to tsdf_fusion: a tracked frame goes there, and the answer to it is awaited before the
// next frame is tracked.
#pragma once

#include <ros/publisher.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "ros/in_process/frames.h"

namespace depth_fusion {

// What fusion said of the frame sent last, or of the map.
struct FusionNews {
  enum Kind { kAccepted, kRejected, kUnanswered, kOtherMap };
  Kind kind;
  std::shared_ptr<const MapView> view;  // null if fusion did not say it itself
};

class FusionLink {
 public:
  // `frames` is the topic icp_tracking/frame.
  explicit FusionLink(const ros::Publisher& frames) : frames_(frames) {}

  // From any thread:
  void receive(const MapViewMessage::ConstPtr& view);
  // Lets await() return at once from now on.
  void stop();
  bool connected() const { return frames_.getNumSubscribers() > 0; }

  // From the tracker's thread:
  // Waits for the answer to the frame sent last, or, before the first, for fusion to tell of its map. Returns
  // all that fusion said since the last call, oldest first. A frame counts as unanswered after a minute, or
  // if nobody is there to answer, and as rejected after stop().
  std::vector<FusionNews> await();
  void send(const SensorFramePtr& frame, std::shared_ptr<const DepthFrame> depth,
            const TrackingResult& tracking);
  // The next frame that is sent begins the map anew, or a part of it.
  void begin(Beginning beginning) { begins_ = beginning; }
  MapMode mode() const { return mode_; }
  bool isBeforeReset(const SensorFrame& frame) const { return reset_.isAfter(frame); }

 private:
  struct Sent {
    ros::Time stamp;
    Beginning begins;
  };

  std::optional<FusionNews> newsOf(const MapViewMessage& message);
  bool isWaiting() const { return sent_ || map_generation_ == 0; }

  ros::Publisher frames_;
  std::optional<Sent> sent_;     // the frame that is not answered yet
  uint32_t map_generation_ = 0;  // 0: there is no map yet
  Beginning begins_ = Beginning::kNone;
  MapMode mode_ = MapMode::kMapping;
  MapReset reset_;

  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  std::deque<MapViewMessage::ConstPtr> views_;
  bool stopping_ = false;
};

}  // namespace depth_fusion
