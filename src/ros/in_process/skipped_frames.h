// Frames that are not tracked, for want of time: their texture's motion counts all the same.
#pragma once

#include <mutex>
#include <vector>

#include "depth_fusion/pipeline/frame_tracker.h"
#include "ros/in_process/frames.h"

namespace depth_fusion {

// Thread-safe.
class SkippedFrames {
 public:
  void add(const TexturedFrame& frame);
  // Tells the tracker of those before the frame.
  void replay(const SensorFrame& frame, FrameTracker& tracker);

 private:
  struct Skipped {
    uint32_t clock_jumps;
    double stamp_s;
    TextureOdometryResult motion;
  };

  std::mutex mutex_;
  std::vector<Skipped> skipped_;
};

}  // namespace depth_fusion
