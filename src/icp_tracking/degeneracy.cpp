#include "icp_tracking/degeneracy.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace depth_fusion {
namespace {

char dominantAxis(const Eigen::Vector3d& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return "xyz"[axis];
}

}  // namespace

DegeneracyAnalysis::DegeneracyAnalysis(const IcpSystem& system, const Eigen::AlignedBox3d& box,
                                       double threshold)
    : to_shrunk_(Matrix6d::Identity()),
      system_(system),
      weights_(system.weights()),
      threshold_(threshold),
      size_(box.sizes()) {
  size_ = size_.cwiseMax(1e-3);
  const Eigen::Matrix3d shrink = size_.cwiseInverse().asDiagonal();
  to_shrunk_.topLeftCorner<3, 3>() = shrink;
  to_shrunk_.topRightCorner<3, 3>() = -shrink * crossMatrix(box.center());
  const Matrix6d shrunk = to_shrunk_ * system.hessian * to_shrunk_.transpose() / weights_;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(shrunk);
  eigenvalues_ = solver.eigenvalues();
  eigenvectors_ = solver.eigenvectors();
  shrunk_gradient_ = to_shrunk_ * system.gradient / weights_;
  while (free_ < 6 && !(eigenvalues_(free_) > threshold)) ++free_;
}

IcpSystem DegeneracyAnalysis::constrained() const {
  const auto kept = eigenvectors_.rightCols(6 - free_);
  const Matrix6d back = to_shrunk_.inverse();
  IcpSystem result = system_;
  result.hessian = weights_ * back * kept * eigenvalues_.tail(6 - free_).asDiagonal() * kept.transpose() *
                   back.transpose();
  result.gradient = weights_ * back * kept * (kept.transpose() * shrunk_gradient_);
  return result;
}

Vector6d DegeneracyAnalysis::solve() const {
  const auto kept = eigenvectors_.rightCols(6 - free_);
  const Eigen::VectorXd components =
      (kept.transpose() * -shrunk_gradient_).cwiseQuotient(eigenvalues_.tail(6 - free_));
  return to_shrunk_.transpose() * (kept * components);
}

std::string DegeneracyAnalysis::namesUpTo(double threshold) const {
  std::string names;
  for (int i = 0; i < 6 && !(eigenvalues_(i) > threshold); ++i) {
    // At the box's centre the shrunk translation is metric; the shrunk rotation is the motion at the box's
    // border.
    const Vector6d shrunk = eigenvectors_.col(i);
    const bool slides = shrunk.tail<3>().norm() > shrunk.head<3>().norm();
    const Eigen::Vector3d axis =
        slides ? Eigen::Vector3d(shrunk.tail<3>()) : Eigen::Vector3d(shrunk.head<3>().cwiseQuotient(size_));
    names += names.empty() ? "" : ", ";
    names += slides ? "sliding along " : "rotating about ";
    names += dominantAxis(axis);
  }
  return names;
}

}  // namespace depth_fusion
