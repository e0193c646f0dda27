#include "icp_tracking/icp_system.h"

#include <array>
#include <cmath>

#include "shared/types.h"

namespace depth_fusion {

double IcpSystem::rmse() const { return weights() > 0.0 ? std::sqrt(squared_residuals / weights()) : 0.0; }

IcpSystem sumRows(const std::vector<float>& partial_sums, int row_step) {
  std::array<double, ICP_SUMS> sums{};
  for (size_t i = 0; i < partial_sums.size(); ++i)
    sums[i % ICP_SUMS] += row_step * static_cast<double>(partial_sums[i]);
  IcpSystem system;
  size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      system.hessian(row, column) = system.hessian(column, row) = sums[next++];
    }
  }
  for (int row = 0; row < 6; ++row) system.gradient(row) = sums[next++];
  system.squared_residuals = sums[next++];
  system.inliers = sums[next++];
  system.source_points = sums[next++];
  system.fit = sums[next++];
  system.covered_points = sums[next];
  return system;
}

}  // namespace depth_fusion
