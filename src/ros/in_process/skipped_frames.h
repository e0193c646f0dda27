// Frames that there was no time to track: what was measured of their motion counts all the same.
#pragma once

#include <mutex>
#include <vector>

#include "depth_fusion/pipeline/tracking_session.h"
#include "ros/in_process/frames.h"

namespace depth_fusion {

// Thread-safe.
class SkippedFrames {
 public:
  void add(const TexturedSensorFrame& frame);
  // Tells the session of the skipped frames that came before this one.
  void replay(const SensorFrame& frame, TrackingSession& session);

 private:
  struct Skipped {
    uint32_t clock_jumps;
    double stamp_s;
    std::vector<FrameMotion> motions;
  };

  std::mutex mutex_;
  std::vector<Skipped> skipped_;
};

}  // namespace depth_fusion
