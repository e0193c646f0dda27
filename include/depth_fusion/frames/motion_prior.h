// What is known of a frame's pose before it is tracked.
#pragma once

#include <optional>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

struct MotionPrior {
  Pose T_W_D = Pose::Identity();
  // Of the twist (rotation, translation) applied to T_W_D on the left; none for a guess without a
  // measurement.
  std::optional<Matrix6d> covariance;
};

}  // namespace depth_fusion
