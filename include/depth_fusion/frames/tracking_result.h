// Where tracking found a frame's camera, and how sure that is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "depth_fusion/frames/motion_prior.h"

namespace depth_fusion {

enum class TrackingStatus {
  kTracking,
  kDegenerate,  // geometry leaves directions free, or says them weakly; the pose has them from a measured
                // prior, or they are guessed
  kLost
};

// How far the pose is from a motion that was measured, in standard deviations of both.
struct PriorDistance {
  std::string origin;
  double sigmas = 0.0;
};

struct TrackingResult {
  TrackingStatus status = TrackingStatus::kLost;
  std::string
      reason;  // why tracking is lost, which directions are free, or why a map begins anew; else empty
  Pose T_W_D = Pose::Identity();  // valid unless lost
  // Both are covariances of the twist applied to T_W_D on the left: this one of how the frame lies to the map
  // that it sees ...
  Matrix6d covariance = Matrix6d::Identity();
  // ... and how that part of the map lies to where the map begins.
  Matrix6d drift = Matrix6d::Zero();
  // What the prior's own covariance leaves in `covariance`, and what stays in the pose of an error of the
  // pose that the prior goes out from: nearly nothing, but along directions that geometry leaves free all of
  // it.
  Matrix6d covariance_of_prior = Matrix6d::Zero();
  Matrix6d share_of_prior = Matrix6d::Zero();
  std::string prior;  // the origin of the prior that tracking began with; empty if the frame was not tracked
  // How far depth alone is from the prior, in standard deviations of both (Mahalanobis, divided by the root
  // of the number of directions that depth constrains); 0 for a prior without a covariance.
  double prior_sigmas = 0.0;
  std::string dropped_prior;  // the origin of a measured prior that depth contradicts; prior_sigmas is its
  std::vector<PriorDistance> priors;  // every motion that was measured, also those that were not used
  // A lost frame has here where the sensor is by the robot's own motion, measured without a gap since it was
  // tracked.
  std::optional<MotionPrior> bridged;
  // The number of free directions that nothing measured: along them the pose is where it was expected.
  int guessed_directions = 0;
  std::string map_doubt;  // why the map may be wrong, and since when; empty if nothing speaks for it
  int inliers = 0;
  double inlier_fraction = 0.0;  // of the frame's points with depth and normal
  // How much of the frame the map explains: the mean, over the points that are seen where the map has a
  // surface, of 1 - (r / (3 sigma))^2, r the point-to-plane distance; 0 where that is negative or where the
  // match is rejected.
  double explained = 0.0;
  double match_quality = 0.0;  // the same mean over the inliers alone
  double rmse_m = 0.0;         // of the inliers' point-to-plane distances, weighted by the sensor's accuracy
  double smallest_eigenvalue = 0.0;  // of the system in the unit cube, divided by the matches' weights
  // What the matches say of the motion that they say least of, as a part of what all points of the frame
  // would say of it if they matched; 1 where a measured prior tells it, or where the motion is free.
  double weakest_said = 1.0;
  int iterations = 0;
};

}  // namespace depth_fusion
