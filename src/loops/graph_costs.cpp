#include "loops/graph_costs.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace depth_fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using RowMajor6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using RowMajor36 = Eigen::Matrix<double, 3, 6, Eigen::RowMajor>;

constexpr double kSmall_rad = 1e-4;

}  // namespace

Matrix3d rightJacobian(const Vector3d& rotation) {
  const double angle = rotation.norm();
  const Matrix3d cross = crossMatrix(rotation);
  if (angle < kSmall_rad) return Matrix3d::Identity() - 0.5 * cross + cross * cross / 6.0;
  const double square = angle * angle;
  return Matrix3d::Identity() - (1.0 - std::cos(angle)) / square * cross +
         (angle - std::sin(angle)) / (square * angle) * cross * cross;
}

Matrix3d inverseRightJacobian(const Vector3d& rotation) {
  const double angle = rotation.norm();
  const Matrix3d cross = crossMatrix(rotation);
  if (angle < kSmall_rad) return Matrix3d::Identity() + 0.5 * cross + cross * cross / 12.0;
  const double half = 0.5 * angle;
  return Matrix3d::Identity() + 0.5 * cross +
         (1.0 - half * std::cos(half) / std::sin(half)) / (angle * angle) * cross * cross;
}

EdgeCost::EdgeCost(const GraphEdge& edge, const Pose& T_W_from, const Pose& T_W_to)
    : T_from_to_start_(orthonormalized(T_W_from.inverse() * T_W_to)),
      T_to_from_measured_(edge.T_from_to.inverse()) {
  const Matrix6d to_right = adjoint(T_to_from_measured_);
  const Matrix6d information =
      (to_right * edge.covariance * to_right.transpose()).ldlt().solve(Matrix6d::Identity());
  root_information_ = Matrix6d(0.5 * (information + information.transpose())).llt().matrixU();
}

// With from = exp(a), to = exp(b) on the right of where they began, the residual is the twist of
// measured^-1 exp(a)^-1 start exp(b).
bool EdgeCost::Evaluate(double const* const* twists, double* residual, double** jacobians) const {
  const Eigen::Map<const Vector6d> a(twists[0]), b(twists[1]);
  const Pose A = poseFromTwist(a), B = poseFromTwist(b);
  const Pose moved = A.inverse() * T_from_to_start_ * B;
  const Vector6d twist = twistFromPose(T_to_from_measured_ * moved);
  const Matrix6d root = weight_ * root_information_;
  Eigen::Map<Vector6d>(residual).noalias() = root * twist;
  if (jacobians == nullptr) return true;
  const Matrix3d R_measured = T_to_from_measured_.linear(), R_A = A.linear().transpose();
  const Matrix3d to_twist = inverseRightJacobian(twist.head<3>());
  if (jacobians[0] != nullptr) {
    const Matrix3d turn = rightJacobian(a.head<3>());
    Matrix6d jacobian = Matrix6d::Zero();
    jacobian.topLeftCorner<3, 3>() = -to_twist * moved.linear().transpose() * turn;
    jacobian.bottomLeftCorner<3, 3>() = R_measured * crossMatrix(moved.translation()) * turn;
    jacobian.bottomRightCorner<3, 3>() = -R_measured * R_A;
    Eigen::Map<RowMajor6>(jacobians[0]).noalias() = root * jacobian;
  }
  if (jacobians[1] != nullptr) {
    Matrix6d jacobian = Matrix6d::Zero();
    jacobian.topLeftCorner<3, 3>() = to_twist * rightJacobian(b.head<3>());
    jacobian.bottomRightCorner<3, 3>() = R_measured * R_A * T_from_to_start_.linear();
    Eigen::Map<RowMajor6>(jacobians[1]).noalias() = root * jacobian;
  }
  return true;
}

GravityCost::GravityCost(const Pose& T_W_D, const Vector3d& down_D, const Vector3d& down_W, double sigma_rad)
    : down_D_start_(T_W_D.linear().transpose() * down_W), down_D_(down_D), sigma_rad_(sigma_rad) {}

bool GravityCost::Evaluate(double const* const* twists, double* residual, double** jacobians) const {
  const Eigen::Map<const Vector6d> a(twists[0]);
  const Vector3d down = poseFromTwist(a).linear().transpose() * down_D_start_;
  Eigen::Map<Vector3d> difference(residual);
  difference = (down - down_D_) / sigma_rad_;
  if (jacobians == nullptr || jacobians[0] == nullptr) return true;
  Eigen::Map<RowMajor36> jacobian(jacobians[0]);
  jacobian.leftCols<3>() = crossMatrix(down) * rightJacobian(a.head<3>()) / sigma_rad_;
  jacobian.rightCols<3>().setZero();
  return true;
}

}  // namespace depth_fusion
