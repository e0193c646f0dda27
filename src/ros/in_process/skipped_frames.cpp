#include "ros/in_process/skipped_frames.h"

namespace depth_fusion {

void SkippedFrames::add(const TexturedSensorFrame& frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  skipped_.push_back(
      {frame.sensor->clock_jumps, frame.sensor->rgbd.stamp_s, frame.texture.measuredMotions()});
}

void SkippedFrames::replay(const SensorFrame& frame, TrackingSession& session, RobotMotion& robot) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Skipped> later;
  for (const Skipped& skipped : skipped_) {
    if (skipped.clock_jumps > frame.clock_jumps || skipped.stamp_s > frame.rgbd.stamp_s) {
      later.push_back(skipped);
    } else if (skipped.clock_jumps == frame.clock_jumps) {
      std::vector<FrameMotion> motions = skipped.motions;
      const std::vector<FrameMotion> others = robot.knowledge(skipped.stamp_s).motions;
      motions.insert(motions.end(), others.begin(), others.end());
      session.skip(skipped.stamp_s, motions);
    }
  }
  skipped_.swap(later);
}

}  // namespace depth_fusion
