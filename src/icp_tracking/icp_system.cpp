#include "icp_tracking/icp_system.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "shared/types.h"

namespace depth_fusion {

double IcpSystem::rmse() const {
  // normals have unit length, so that the trace of the translation block is the sum of the weights
  const double weights = hessian.bottomRightCorner<3, 3>().trace();
  return weights > 0.0 ? std::sqrt(squared_residuals / weights) : 0.0;
}

IcpSystem sumRows(const std::vector<float>& partial_sums) {
  std::array<double, ICP_SUMS> sums{};
  for (size_t i = 0; i < partial_sums.size(); ++i) sums[i % ICP_SUMS] += partial_sums[i];
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
  system.source_points = sums[next];
  return system;
}

std::optional<Vector6d> solve(const IcpSystem& system) {
  const Eigen::LDLT<Matrix6d> factors(system.hessian);
  const double largest = system.hessian.diagonal().maxCoeff();
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > 1e-9 * largest)) return std::nullopt;
  return factors.solve(-system.gradient);
}

}  // namespace depth_fusion
