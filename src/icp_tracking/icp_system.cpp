#include "icp_tracking/icp_system.h"

#include <array>
#include <cmath>

#include "shared/types.h"

namespace depth_fusion {

double IcpSystem::rmse() const { return weights > 0.0 ? std::sqrt(squared_residuals / weights) : 0.0; }

namespace {

// The symmetric matrix whose upper triangle follows row by row.
Matrix6d symmetric(const double* triangle) {
  Matrix6d matrix;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) matrix(row, column) = matrix(column, row) = *triangle++;
  }
  return matrix;
}

}  // namespace

IcpSystem sumRows(const std::vector<float>& partial_sums, int row_step) {
  std::array<double, ICP_SUMS> sums{};
  for (size_t i = 0; i < partial_sums.size(); ++i)
    sums[i % ICP_SUMS] += row_step * static_cast<double>(partial_sums[i]);
  IcpSystem system;
  system.hessian = symmetric(&sums[0]);
  size_t next = 21;
  for (int row = 0; row < 6; ++row) system.gradient(row) = sums[next++];
  system.squared_residuals = sums[next++];
  system.inliers = sums[next++];
  system.source_points = sums[next++];
  system.fit = sums[next++];
  system.covered_points = sums[next++];
  system.weights = sums[next++];
  system.structure = 0.5 * symmetric(&sums[next]);
  return system;
}

}  // namespace depth_fusion
