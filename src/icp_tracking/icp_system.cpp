#include "icp_tracking/icp_system.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "shared/types.h"

namespace depth_fusion {

namespace {

// As many as leave each taller than what neighbours share.
constexpr size_t kBands = 16;
constexpr size_t kGradient = 21;  // where it begins among a row's sums

// The symmetric matrix whose upper triangle follows row by row.
Matrix6d symmetric(const double* triangle) {
  Matrix6d matrix;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) matrix(row, column) = matrix(column, row) = *triangle++;
  }
  return matrix;
}

// See IcpSystem::scatter.
Matrix6d scatterOf(const std::vector<float>& partial_sums, int row_step) {
  const size_t rows = partial_sums.size() / ICP_SUMS;
  std::array<Vector6d, kBands> gradients;
  gradients.fill(Vector6d::Zero());
  Vector6d mean = Vector6d::Zero();
  for (size_t row = 0; row < rows; ++row) {
    const float* sums = &partial_sums[row * ICP_SUMS + kGradient];
    Vector6d& gradient = gradients[row * kBands / rows];
    for (int i = 0; i < 6; ++i) gradient(i) += row_step * static_cast<double>(sums[i]);
  }
  for (const Vector6d& gradient : gradients) mean += gradient / kBands;
  Matrix6d scatter = Matrix6d::Zero();
  for (const Vector6d& gradient : gradients) scatter += (gradient - mean) * (gradient - mean).transpose();
  return scatter * (kBands / (kBands - 1.0));
}

}  // namespace

double IcpSystem::rmse() const { return weights > 0.0 ? std::sqrt(squared_residuals / weights) : 0.0; }

double IcpSystem::correlated() const {
  const double unit = static_cast<double>(ICP_UNIT_SIGMA_M) * ICP_UNIT_SIGMA_M;
  const double excess = hessian.completeOrthogonalDecomposition().solve(scatter).trace() / (6.0 * unit);
  return std::max(excess, 1.0);
}

IcpSystem sumRows(const std::vector<float>& partial_sums, int row_step) {
  std::array<double, ICP_SUMS> sums{};
  for (size_t first = 0; first < partial_sums.size(); first += ICP_SUMS) {
    for (size_t i = 0; i < ICP_SUMS; ++i) sums[i] += row_step * static_cast<double>(partial_sums[first + i]);
  }
  IcpSystem system;
  system.hessian = symmetric(&sums[0]);
  size_t next = kGradient;
  for (int row = 0; row < 6; ++row) system.gradient(row) = sums[next++];
  system.squared_residuals = sums[next++];
  system.inliers = sums[next++];
  system.source_points = sums[next++];
  system.fit = sums[next++];
  system.covered_points = sums[next++];
  system.weights = sums[next++];
  system.structure = 0.5 * symmetric(&sums[next]);
  system.scatter = scatterOf(partial_sums, row_step);
  return system;
}

}  // namespace depth_fusion
