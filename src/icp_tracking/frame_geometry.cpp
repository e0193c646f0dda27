#include "icp_tracking/frame_geometry.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/compute/device_image.h"
#include "shared/types.h"

namespace depth_fusion {
namespace {

// A point of the level, seen from M, and how much it counts.
struct Point {
  Eigen::Vector3d p_M;
  double weight;
};

Point pointAt(int u, int v, double z, const DepthLevel& level, const Pose& T_M_D) {
  const CameraIntrinsics& camera = level.camera;
  const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
  const double sigma_m = AXIAL_SIGMA_M(level.sensor, z);
  return {T_M_D * (z * ray), 1.0 / (sigma_m * sigma_m)};
}

}  // namespace

Eigen::AlignedBox3d spreadBox(const DepthLevel& level, const Pose& T_M_D) {
  const cv::Mat depth = readImage(level.depth, level.camera);
  double weights = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const double z = depth.at<float>(v, u);
      if (z <= 0.0) continue;
      const Point point = pointAt(u, v, z, level, T_M_D);
      weights += point.weight;
      sum += point.weight * point.p_M;
      squares += point.weight * point.p_M.cwiseAbs2();
    }
  }
  if (weights <= 0.0) return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()};
  const Eigen::Vector3d mean = sum / weights;
  const double half_size = std::sqrt(std::max((squares / weights - mean.cwiseAbs2()).sum(), 0.0));
  const Eigen::Vector3d half_diagonal = Eigen::Vector3d::Constant(half_size);
  return {mean - half_diagonal, mean + half_diagonal};
}

double informationAlong(const Vector6d& twist, const DepthLevel& level, const Pose& T_M_D) {
  const cv::Mat depth = readImage(level.depth, level.camera);
  const cv::Mat normals = readNormals(level.normals, level.camera);
  double weights = 0.0, sum = 0.0;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const double z = depth.at<float>(v, u);
      const cv::Vec3f& n = normals.at<cv::Vec3f>(v, u);
      if (z <= 0.0 || n == cv::Vec3f()) continue;
      const Point point = pointAt(u, v, z, level, T_M_D);
      const Eigen::Vector3d motion = twist.tail<3>() + twist.head<3>().cross(point.p_M);
      const double along_normal = motion.dot(T_M_D.linear() * Eigen::Vector3d(n[0], n[1], n[2]));
      weights += point.weight;
      sum += point.weight * along_normal * along_normal;
    }
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

}  // namespace depth_fusion
