#include "icp_tracking/degeneracy.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

// Pixels whose normals share their errors.
constexpr double kAlikeNormals = 30.0;

char dominantAxis(const Eigen::Vector3d& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return "xyz"[axis];
}

}  // namespace

DegeneracyAnalysis::DegeneracyAnalysis(const IcpSystem& system, const Matrix6d& judged,
                                       const Eigen::AlignedBox3d& box, double threshold)
    : to_shrunk_(Matrix6d::Identity()), system_(system), threshold_(threshold), size_(box.sizes()) {
  size_ = size_.cwiseMax(1e-3);
  const Eigen::Matrix3d shrink = size_.cwiseInverse().asDiagonal();
  to_shrunk_.topLeftCorner<3, 3>() = shrink;
  to_shrunk_.topRightCorner<3, 3>() = -shrink * crossMatrix(box.center());
  const Matrix6d shrunk = to_shrunk_ * judged * to_shrunk_.transpose() / system.weights;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(shrunk);
  eigenvalues_ = solver.eigenvalues();
  eigenvectors_ = solver.eigenvectors();
  const Matrix6d hessian = to_shrunk_ * system.hessian * to_shrunk_.transpose() / system.weights;
  const Vector6d noise = (eigenvectors_.transpose() * hessian * eigenvectors_).diagonal() - eigenvalues_;
  uncertainties_ = noise.cwiseMax(0.0) * std::sqrt(kAlikeNormals / std::max(system.inliers, 1.0));
  free_ = freeUpTo(threshold);
}

IcpSystem DegeneracyAnalysis::constrained() const {
  const auto kept = eigenvectors_.rightCols(6 - free_);
  const Matrix6d projection = to_shrunk_.inverse() * kept * kept.transpose() * to_shrunk_;
  IcpSystem result = system_;
  result.hessian = projection * system_.hessian * projection.transpose();
  result.gradient = projection * system_.gradient;
  return result;
}

Vector6d DegeneracyAnalysis::solve(const Vector6d& so_far) const {
  const Eigen::MatrixXd kept = to_shrunk_.transpose() * eigenvectors_.rightCols(6 - free_);
  const Eigen::MatrixXd hessian = kept.transpose() * system_.hessian * kept;
  const auto free = eigenvectors_.leftCols(free_);
  const Vector6d back =
      to_shrunk_.transpose() * (free * (free.transpose() * (to_shrunk_.transpose().inverse() * so_far)));
  return kept * hessian.ldlt().solve(kept.transpose() * -system_.gradient) - back;
}

int DegeneracyAnalysis::freeUpTo(double threshold) const {
  int free = 0;
  while (threshold > 0.0 && free < 6 && !(eigenvalues_(free) > threshold + uncertainties_(free))) ++free;
  return free;
}

std::string DegeneracyAnalysis::namesUpTo(double threshold) const {
  std::string names;
  for (int i = 0; i < freeUpTo(threshold); ++i) names += (names.empty() ? "" : ", ") + nameOf(i);
  return names;
}

std::string DegeneracyAnalysis::nameOf(int i) const {
  // At the box's centre the shrunk translation is metric; the shrunk rotation is the motion at the box's
  // border.
  const Vector6d shrunk = eigenvectors_.col(i);
  const bool slides = shrunk.tail<3>().norm() > shrunk.head<3>().norm();
  const Eigen::Vector3d axis =
      slides ? Eigen::Vector3d(shrunk.tail<3>()) : Eigen::Vector3d(shrunk.head<3>().cwiseQuotient(size_));
  return std::string(slides ? "sliding along " : "rotating about ") + dominantAxis(axis);
}

}  // namespace depth_fusion
