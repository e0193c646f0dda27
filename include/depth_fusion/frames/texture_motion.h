// The motion of a frame's texture since the frame before.
#pragma once

#include <string>

#include "depth_fusion/frames/motion_prior.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

struct TextureOdometryResult {
  bool found = false;
  std::string reason;                          // why no motion was found; empty otherwise
  Pose T_previous_current = Pose::Identity();  // depth camera frames; valid if found
  Matrix6d covariance = Matrix6d::Zero();  // of the twist (rotation, translation) applied to it on the left
  int features = 0;                        // of the current frame
  int matches = 0;
  int inliers = 0;

  // The current frame's pose, if the previous one's is known exactly.
  MotionPrior priorFrom(const Pose& T_W_previous) const;
};

}  // namespace depth_fusion
