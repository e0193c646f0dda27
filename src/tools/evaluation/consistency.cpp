#include "tools/evaluation/consistency.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace depth_fusion {

DriftParameters driftOfNoise() {
  DriftParameters drift;
  drift.frame_m = drift.frame_rad = 0.0f;
  drift.m_after_1m = 0.0002f;
  drift.rad_after_1m = 0.0004f;
  drift.m_after_1rad = 0.0003f;
  drift.rad_after_1rad = 0.0001f;
  return drift;
}

double nees(const Vector6d& error, const Matrix6d& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

NeesBounds neesBounds(int runs) {
  constexpr double kNormal95 = 1.959964;
  const double freedom = 6.0 * runs;
  const auto quantile = [&](double normal) {
    return freedom * std::pow(1.0 - 2.0 / (9.0 * freedom) + normal * std::sqrt(2.0 / (9.0 * freedom)), 3.0);
  };
  return {quantile(-kNormal95) / runs, quantile(kNormal95) / runs};
}

}  // namespace depth_fusion
