// Where tracking found a frame's camera, and how sure that is.
#pragma once

#include <string>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

enum class TrackingStatus {
  kTracking,
  kDegenerate,  // geometry leaves directions free; the pose has them from the prior
  kLost
};

struct TrackingResult {
  TrackingStatus status = TrackingStatus::kLost;
  std::string reason;             // why tracking is lost, or which directions are free; else empty
  Pose T_W_D = Pose::Identity();  // valid unless lost
  Matrix6d covariance = Matrix6d::Identity();  // of the twist applied to T_W_D on the left
  std::string prior;  // the origin of the prior that tracking began with; empty if the frame was not tracked
  int inliers = 0;
  double inlier_fraction = 0.0;  // of the frame's points with depth and normal
  double rmse_m = 0.0;  // of the inliers' point-to-plane distances, weighted by the sensor's accuracy
  double smallest_eigenvalue = 0.0;  // of the system in the unit cube, divided by the matches' weights
  int iterations = 0;
};

}  // namespace depth_fusion
