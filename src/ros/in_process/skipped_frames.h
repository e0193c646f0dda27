// Frames that there was no time to track: what was measured of their motion counts all the same.
#pragma once

#include <mutex>
#include <vector>

#include "depth_fusion/pipeline/tracking_session.h"
#include "depth_fusion/robot_motion/robot_motion.h"
#include "ros/in_process/frames.h"

namespace depth_fusion {

// Thread-safe.
class SkippedFrames {
 public:
  void add(const TexturedSensorFrame& frame);
  // Tells the session of the skipped frames that came before this one, with what the robot knows of them.
  void replay(const SensorFrame& frame, TrackingSession& session, RobotMotion& robot);

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
