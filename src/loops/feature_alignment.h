// How two keyframes lie to each other, by features that look alike.
#pragma once

#include "depth_fusion/frames/frame_features.h"
#include "depth_fusion/loops/loop_parameters.h"

namespace depth_fusion {

struct FeatureAlignment {
  int matches = 0;
  int inliers = 0;
  bool is_found = false;
  Pose T_old_new = Pose::Identity();       // of the depth cameras
  Matrix6d covariance = Matrix6d::Zero();  // of the twist on the left
};

FeatureAlignment alignFeatures(const FrameFeatures& old_features, const FrameFeatures& new_features,
                               const LoopParameters& parameters);

}  // namespace depth_fusion
