#include "tools/report/level.h"

namespace depth_fusion {
namespace {

const Eigen::Vector3f kUp(0.0f, -1.0f, 0.0f);

}  // namespace

Eigen::Matrix3d levelFrom(const TriangleMesh& mesh) {
  constexpr float kFirst_cos = 0.6f, kLast_cos = 0.97f;
  constexpr int kRounds = 12;
  constexpr float kLeastShare = 0.02f;  // of all vertices
  Eigen::Vector3f up = kUp;
  size_t level = 0;
  for (int round = 0; round < kRounds; ++round) {
    const float least_cos = kFirst_cos + (kLast_cos - kFirst_cos) * static_cast<float>(round) / (kRounds - 1);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    level = 0;
    for (const MeshVertex& vertex : mesh.vertices) {
      if (vertex.normal_W.dot(up) < least_cos) continue;
      sum += vertex.normal_W;
      ++level;
    }
    if (level > 0) up = sum.normalized();
  }
  if (static_cast<float>(level) < kLeastShare * static_cast<float>(mesh.vertices.size()) || level == 0)
    return Eigen::Matrix3d::Identity();
  return Eigen::Quaterniond::FromTwoVectors(up.cast<double>(), kUp.cast<double>()).toRotationMatrix();
}

TriangleMesh rotated(const Eigen::Matrix3d& rotation, const TriangleMesh& mesh) {
  const Eigen::Matrix3f turn = rotation.cast<float>();
  TriangleMesh result = mesh;
  for (MeshVertex& vertex : result.vertices) vertex = {turn * vertex.position_W, turn * vertex.normal_W};
  return result;
}

Trajectory rotated(const Eigen::Matrix3d& rotation, const Trajectory& trajectory) {
  Trajectory result = trajectory;
  for (StampedPose& pose : result) pose.T_W_D = Pose(rotation) * pose.T_W_D;
  return result;
}

}  // namespace depth_fusion
