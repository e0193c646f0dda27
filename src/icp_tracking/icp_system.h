// The 6x6 system of one ICP iteration.
#pragma once

#include <vector>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Sum over the inliers of w J^T J x = -w J^T r, with x = (rotation, translation) applied on the left.
struct IcpSystem {
  Matrix6d hessian = Matrix6d::Zero();
  // An estimate of the hessian without the share of the normals' noise; slightly indefinite where nothing
  // else is left.
  Matrix6d structure = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double squared_residuals = 0.0;  // weighted
  double inliers = 0.0;
  double source_points = 0.0;
  double fit = 0.0;             // sum over the inliers of 1 - (r / (ICP_FIT_SIGMAS sigma))^2, each at least 0
  double covered_points = 0.0;  // source points that are seen where the model has a surface
  double weights = 0.0;         // sum over the inliers
  // Sum over the bands of rows of g g^T, g what a band's gradient differs by from their mean.
  Matrix6d scatter = Matrix6d::Zero();

  double rmse() const;  // metres, weighted
  // How many matches count as one independent measurement, 1 at least: how much more the gradients of the
  // bands scatter than those of independent residuals with the sensor's sigma would. Errors that neighbours
  // share, of the frame and of the model, are in it (the "meat" of a cluster-robust covariance: K.-Y. Liang,
  // S. Zeger, "Longitudinal data analysis using generalized linear models", Biometrika 1986).
  double correlated() const;
};

// Adds up the rows' partial sums (ICP_SUMS each), in double and in order, so that the result is repeatable.
// Each row stands for row_step rows.
IcpSystem sumRows(const std::vector<float>& partial_sums, int row_step);

}  // namespace depth_fusion
