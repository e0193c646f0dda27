// The motion between frames by the robot's odometry.
#pragma once

#include <deque>
#include <optional>

#include "depth_fusion/frames/motion_prior.h"
#include "depth_fusion/frames/motion_readings.h"
#include "depth_fusion/robot_motion/robot_motion_parameters.h"

namespace depth_fusion {

// Readings may be late, rare, jump or end: where they do not reach a frame, they are drawn on, half a second
// at most, and what that was wrong by is in the next motion.
class WheelOdometry {
 public:
  // A reading whose stamp is no news is left out. One that no robot gets to begins anew.
  void add(const OdometryReading& reading);
  // The motion since the frame asked for before; none if odometry does not tell.
  std::optional<FrameMotion> motionTo(double stamp_s, const RobotMotionParameters& parameters);

 private:
  struct Place {
    Pose T_O_D;
    double drawn_on_s;        // beyond the newest reading
    double way_m, angle_rad;  // that odometry has made by then
  };
  // A reading, and the way to it.
  struct Passed {
    OdometryReading reading;
    double way_m, angle_rad;
  };

  std::optional<Place> at(double stamp_s) const;

  std::deque<Passed> passed_;
  std::optional<Place> before_;  // where odometry was taken to be at the frame before
};

}  // namespace depth_fusion
