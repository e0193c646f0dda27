// The rigid motion between two colour images from pairs of pixels with depth in one or both.
#pragma once

#include <optional>
#include <vector>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Holds what one colour camera sees of a point.
struct Sighting {
  Eigen::Vector2d pixel;
  std::optional<Eigen::Vector3d> point;  // in the camera's frame, where there is depth
  double depth_sigma_m = 0.0;            // standard deviation of the point's depth
};

struct Correspondence {
  Sighting reference, current;
  double sigma_px = 1.0;  // standard deviation of the pixels, up to a common factor

  bool hasDepth() const { return reference.point || current.point; }
};

struct MotionCameras {
  CameraIntrinsics reference, current;
};

struct InlierGate {
  double max_reprojection_sigmas = 3.0;
  double max_depth_sigmas = 4.0;
};

struct MotionEstimate {
  Pose T_reference_current = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  // of the twist on the left
  std::vector<size_t> inliers;             // indices of correspondences
};

// Finds the motion that most correspondences agree on; returns nothing if no three of them give one. The same
// input gives the same result.
std::optional<MotionEstimate> estimateByRansac(const std::vector<Correspondence>& correspondences,
                                               const MotionCameras& cameras, const InlierGate& gate,
                                               int max_iterations);

// Refines `start` by Gauss-Newton with a robust loss over the correspondences within the gate; the covariance
// comes from their residuals, and from an error that they share, shared_error of how far they move. Returns
// nothing if they do not determine the motion.
std::optional<MotionEstimate> refineMotion(const std::vector<Correspondence>& correspondences,
                                           const MotionCameras& cameras, const InlierGate& gate,
                                           const Pose& start, double shared_error = 0.0);

}  // namespace depth_fusion
