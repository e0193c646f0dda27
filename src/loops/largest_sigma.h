// How sure the weakest direction of a position, or of an orientation, is.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace depth_fusion {

// The standard deviation in the direction in which it is largest.
inline double largestSigma(const Eigen::Matrix3d& covariance) {
  return std::sqrt(
      std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues().maxCoeff()));
}

}  // namespace depth_fusion
