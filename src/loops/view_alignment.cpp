#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "loops/view_surface.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr double kGates_m[] = {0.2, 0.1, 0.05};
constexpr int kIterations = 6;  // at each gate
constexpr double kNormal_cos = 0.75;
constexpr double kHuber_sigmas = 1.5;
constexpr double kConverged = 1e-5;
// Residuals of so many neighbours are alike: as many say as much as one.
constexpr double kAlike = 25.0;
constexpr size_t kMinPoints = 100;

struct Sums {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  size_t points = 0, covered = 0, inliers = 0;
  double squares_m2 = 0.0, squares = 0.0;
};

void addMatch(const SurfacePoint& sample, const Vector3d& point, const SurfacePoint& match, Sums& sums) {
  const double distance_m = match.normal.dot(point - match.point);
  const double sigma_m = std::hypot(sample.sigma_m, match.sigma_m);
  const double sigmas = std::abs(distance_m) / sigma_m;
  const double weight = (sigmas > kHuber_sigmas ? kHuber_sigmas / sigmas : 1.0) / (sigma_m * sigma_m);
  Vector6d row;
  row << point.cross(match.normal), match.normal;
  sums.hessian.noalias() += weight * row * row.transpose();
  sums.gradient.noalias() += weight * distance_m * row;
  ++sums.inliers;
  sums.squares_m2 += distance_m * distance_m;
  sums.squares += sigmas * sigmas;
}

Sums match(const ViewSurface& old_view, const ViewSurface& new_view, const Pose& T_old_new, double gate_m) {
  Sums sums;
  for (const SurfacePoint& sample : new_view.points()) {
    ++sums.points;
    const Vector3d point = T_old_new * sample.point;
    const SurfacePoint* seen = old_view.seenTowards(point);
    if (seen == nullptr) continue;
    // What is hidden behind the old surface is not covered by it.
    sums.covered += point.z() < seen->point.z() + gate_m;
    if ((point - seen->point).squaredNorm() > gate_m * gate_m) continue;
    if (seen->normal.dot(T_old_new.linear() * sample.normal) < kNormal_cos) continue;
    addMatch(sample, point, *seen, sums);
  }
  return sums;
}

// Returns false where nothing determines the pose.
bool step(const Sums& sums, const Pose& T_prior, const Matrix6d& prior_information, Pose& T_old_new,
          Matrix6d& covariance, double& length) {
  const Vector6d from_prior = twistFromPose(T_old_new * T_prior.inverse());
  const Matrix6d hessian = sums.hessian / kAlike + prior_information;
  const Eigen::LDLT<Matrix6d> factors(hessian);
  if (factors.info() != Eigen::Success || !factors.isPositive()) return false;
  const Vector6d twist = factors.solve(-sums.gradient / kAlike - prior_information * from_prior);
  if (!twist.allFinite()) return false;
  T_old_new = orthonormalized(poseFromTwist(twist) * T_old_new);
  covariance = factors.solve(Matrix6d::Identity());
  length = twist.norm();
  return true;
}

}  // namespace

ViewAlignment alignViews(const ViewSurface& old_view, const ViewSurface& new_view, const Pose& T_old_new,
                         const Matrix6d& covariance) {
  ViewAlignment result;
  result.T_old_new = T_old_new;
  const Matrix6d prior_information = covariance.ldlt().solve(Matrix6d::Identity());
  Sums sums;
  for (const double gate_m : kGates_m) {
    for (int i = 0; i < kIterations; ++i) {
      sums = match(old_view, new_view, result.T_old_new, gate_m);
      double length = 0.0;
      if (sums.inliers < kMinPoints ||
          !step(sums, T_old_new, prior_information, result.T_old_new, result.covariance, length))
        return result;
      if (length < kConverged) break;
    }
  }
  sums = match(old_view, new_view, result.T_old_new, kGates_m[2]);
  if (sums.inliers < kMinPoints) return result;
  const auto inliers = static_cast<double>(sums.inliers);
  result.overlap = inliers / static_cast<double>(std::min(sums.points, old_view.points().size()));
  result.rmse_m = std::sqrt(sums.squares_m2 / inliers);
  result.rmse_sigmas = std::sqrt(sums.squares / inliers);
  result.is_found = true;
  return result;
}

}  // namespace depth_fusion
