// What is known of a frame's pose before it is tracked.
#pragma once

#include <optional>
#include <string>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

struct MotionPrior {
  Pose T_W_D = Pose::Identity();
  // The covariance is that of the twist (rotation, translation) applied to T_W_D on the left; a guess without
  // a measurement has none.
  std::optional<Matrix6d> covariance;
  std::string
      origin;  // what says so: "texture", "last pose", "constant velocity", "search", "start", "part start"
};

// Tracking from either comes to the same.
inline bool saysTheSame(const MotionPrior& a, const MotionPrior& b) {
  return !a.covariance && !b.covariance && a.T_W_D.matrix() == b.T_W_D.matrix();
}

// How the sensor moved since the frame before, as one of its origins (texture, wheels, a gyroscope) measures
// it.
struct FrameMotion {
  std::string origin;
  Pose T_previous_current = Pose::Identity();  // between depth camera frames
  Matrix6d covariance = Matrix6d::Zero();  // of the twist (rotation, translation) applied to it on the left

  // The current frame's pose, if the previous one's is known exactly.
  MotionPrior priorFrom(const Pose& T_W_previous) const;
};

}  // namespace depth_fusion
