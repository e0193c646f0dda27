// What is known of the sensor's pose in a world whose z is up, whatever its motion: gravity, a flat floor.
#pragma once

#include <optional>

#include "depth_fusion/frames/motion_prior.h"

namespace depth_fusion {

// Upwards, for a camera that is held level.
const Eigen::Vector3d kCameraUp = -Eigen::Vector3d::UnitY();

struct KnownAttitude {
  std::optional<Eigen::Vector3d> up_D;  // unit vector against gravity
  double up_sigma_rad = 0.0;
  std::optional<Pose> T_D_B = {};  // of a ground robot, whose base B keeps upright and at one height
  double base_height_m = 0.0;      // of B in W

  bool empty() const { return !up_D && !T_D_B; }
  // Has the prior know it, too: a ground robot's is moved to the floor.
  void addTo(MotionPrior& prior) const;
  // Whether gravity as it is measured at T_W_D is along W's z, to a few degrees.
  bool agreesAt(const Pose& T_W_D) const;
};

// Where a map begins by what is known: a ground robot's base at the origin, or the camera, level; else the
// identity.
Pose startPose(const KnownAttitude& attitude);

// The pose at the origin whose camera looks along x as far as it can with z up.
Pose levelPose(const Eigen::Vector3d& up_D);

}  // namespace depth_fusion
