#include "texture_odometry/motion_system.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "texture_odometry/feature_depth.h"

namespace depth_fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using PointJacobian = Eigen::Matrix<double, 3, 6>;

constexpr double kMinDepth_m = 0.05;
constexpr double kCauchyScale = 2.0;
constexpr double kConvergence = 1e-7;

Eigen::Matrix<double, 2, 3> projectionJacobian(const CameraIntrinsics& camera, const Vector3d& point) {
  const double inverse_z = 1.0 / point.z();
  Eigen::Matrix<double, 2, 3> jacobian;
  jacobian << camera.fx * inverse_z, 0.0, -camera.fx * point.x() * inverse_z * inverse_z, 0.0,
      camera.fy * inverse_z, -camera.fy * point.y() * inverse_z * inverse_z;
  return jacobian;
}

template <class Jacobian, class Residual>
void addRobust(const Jacobian& jacobian, const Residual& residual, double weight, MotionSystem& system) {
  const double robust = weight / (1.0 + residual.squaredNorm() / (kCauchyScale * kCauchyScale));
  system.hessian.noalias() += robust * jacobian.transpose() * jacobian;
  system.gradient.noalias() += robust * jacobian.transpose() * residual;
}

double depthDifferenceSigma(const Correspondence& pair) {
  return std::hypot(pair.reference.depth_sigma_m, pair.current.depth_sigma_m);
}

}  // namespace

bool MotionResiduals::within(const InlierGate& gate) const {
  if (behind_camera) return false;
  if (in_reference && in_reference->norm() > gate.max_reprojection_sigmas) return false;
  if (in_current && in_current->norm() > gate.max_reprojection_sigmas) return false;
  return !depth || std::abs(*depth) <= gate.max_depth_sigmas;
}

MotionResiduals MotionModel::residuals(size_t index, const Pose& T_reference_current) const {
  const Correspondence& pair = correspondences_[index];
  MotionResiduals result;
  if (pair.current.point) {
    const Vector3d point = T_reference_current * *pair.current.point;
    result.behind_camera |= point.z() < kMinDepth_m;
    result.in_reference = (project(cameras_.reference, point) - pair.reference.pixel) / pair.sigma_px;
    if (pair.reference.point)
      result.depth = (point.z() - pair.reference.point->z()) / depthDifferenceSigma(pair);
  }
  if (pair.reference.point) {
    const Vector3d point = T_reference_current.inverse() * *pair.reference.point;
    result.behind_camera |= point.z() < kMinDepth_m;
    result.in_current = (project(cameras_.current, point) - pair.current.pixel) / pair.sigma_px;
  }
  return result;
}

void MotionModel::accumulate(size_t index, const Pose& T_reference_current, const NoiseScale& noise,
                             MotionSystem& system) const {
  const Correspondence& pair = correspondences_[index];
  const MotionResiduals residual = residuals(index, T_reference_current);
  if (residual.behind_camera) return;
  const double pixel_scale = 1.0 / (pair.sigma_px * noise.pixels);
  // A correspondence that is used both ways counts the noise of the same two pixels twice.
  const double pixel_weight = residual.in_reference && residual.in_current ? 0.5 : 1.0;
  PointJacobian point_jacobian;
  if (residual.in_reference) {
    const Vector3d point = T_reference_current * *pair.current.point;
    point_jacobian << -crossMatrix(point), Matrix3d::Identity();
    const Eigen::Matrix<double, 2, 6> jacobian =
        pixel_scale * projectionJacobian(cameras_.reference, point) * point_jacobian;
    addRobust(jacobian, Vector2d(*residual.in_reference / noise.pixels), pixel_weight, system);
    if (residual.depth) {
      const Eigen::Matrix<double, 1, 6> depth_jacobian =
          point_jacobian.row(2) / (depthDifferenceSigma(pair) * noise.depth);
      addRobust(depth_jacobian, Eigen::Matrix<double, 1, 1>(*residual.depth / noise.depth), 1.0, system);
    }
  }
  if (residual.in_current) {
    const Matrix3d R_current_reference = T_reference_current.linear().transpose();
    const Vector3d point = T_reference_current.inverse() * *pair.reference.point;
    point_jacobian << R_current_reference * crossMatrix(*pair.reference.point), -R_current_reference;
    const Eigen::Matrix<double, 2, 6> jacobian =
        pixel_scale * projectionJacobian(cameras_.current, point) * point_jacobian;
    addRobust(jacobian, Vector2d(*residual.in_current / noise.pixels), pixel_weight, system);
  }
}

std::optional<Pose> solveMotion(const MotionModel& model, const std::vector<size_t>& indices,
                                const NoiseScale& noise, const Pose& start, int max_iterations) {
  Pose T_reference_current = start;
  for (int i = 0; i < max_iterations; ++i) {
    MotionSystem system;
    for (const size_t index : indices) model.accumulate(index, T_reference_current, noise, system);
    const Eigen::LDLT<Matrix6d> factors(system.hessian);
    if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > 0.0)) return std::nullopt;
    const Vector6d twist = factors.solve(-system.gradient);
    if (!twist.allFinite()) return std::nullopt;
    T_reference_current = poseFromTwist(twist) * T_reference_current;
    if (twist.norm() < kConvergence) break;
  }
  return orthonormalized(T_reference_current);
}

}  // namespace depth_fusion
