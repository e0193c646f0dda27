#include "depth_fusion/loops/corrections.h"

#include <Eigen/SVD>
#include <algorithm>

namespace depth_fusion {
namespace {

Pose carried(const CorrectedKeyframe& keyframe, const Pose& T_W_D) {
  return orthonormalized(keyframe.T_W_now * keyframe.T_W_then.inverse() * T_W_D);
}

}  // namespace

Pose Corrections::corrected(const Pose& T_W_D, double way_m) const {
  if (keyframes_.empty()) return T_W_D;
  const auto after =
      std::upper_bound(keyframes_.begin(), keyframes_.end(), way_m,
                       [](double way, const CorrectedKeyframe& keyframe) { return way < keyframe.way_m; });
  if (after == keyframes_.begin()) return carried(keyframes_.front(), T_W_D);
  if (after == keyframes_.end()) return carried(keyframes_.back(), T_W_D);
  const CorrectedKeyframe& before = *(after - 1);
  return interpolate({before.way_m, carried(before, T_W_D)}, {after->way_m, carried(*after, T_W_D)}, way_m);
}

Pose Corrections::meanMotion(const std::vector<uint32_t>& indices) const {
  if (indices.empty()) return Pose::Identity();
  Eigen::Vector3d middle_then = Eigen::Vector3d::Zero(), middle_now = Eigen::Vector3d::Zero();
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
  for (const uint32_t index : indices) {
    const CorrectedKeyframe& keyframe = keyframes_.at(index);
    middle_then += keyframe.T_W_then.translation() / static_cast<double>(indices.size());
    middle_now += keyframe.T_W_now.translation() / static_cast<double>(indices.size());
    turns += keyframe.T_W_now.linear() * keyframe.T_W_then.linear().transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turns, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  Pose motion = Pose::Identity();
  motion.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  motion.translation() = middle_now - motion.linear() * middle_then;
  return motion;
}

}  // namespace depth_fusion
