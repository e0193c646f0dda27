#include "ros/in_process/skipped_frames.h"

namespace depth_fusion {

void SkippedFrames::add(const TexturedFrame& frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  skipped_.push_back({frame.sensor->clock_jumps, frame.sensor->rgbd.stamp_s, frame.motion});
}

void SkippedFrames::replay(const SensorFrame& frame, FrameTracker& tracker) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Skipped> later;
  for (const Skipped& skipped : skipped_) {
    if (skipped.clock_jumps > frame.clock_jumps || skipped.stamp_s > frame.rgbd.stamp_s) {
      later.push_back(skipped);
    } else if (skipped.clock_jumps == frame.clock_jumps) {
      tracker.skip(skipped.stamp_s, skipped.motion);
    }
  }
  skipped_.swap(later);
}

}  // namespace depth_fusion
