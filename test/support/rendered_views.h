// Maps of analytic surfaces, views of them, and how far these are from the truth.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/model_view/model_view_renderer.h"
#include "reference/map_from_distance.h"
#include "shared/types.h"
#include "support/map_contents.h"
#include "support/normal_images.h"
#include "support/test_compute.h"

namespace depth_fusion {

constexpr CameraIntrinsics kCamera{101, 75, 95.0, 97.0, 50.3, 36.9};
constexpr float kMinRange_m = 0.2f;
constexpr float kMaxRange_m = 4.0f;

inline MapParameters mapParameters(int block_size, int blocks_per_axis = 0) {
  MapParameters parameters;
  parameters.voxel_size_m = 0.01f;
  parameters.truncation_m = 0.04f;
  parameters.block_size = block_size;
  parameters.blocks_per_axis = blocks_per_axis > 0 ? blocks_per_axis : 2 * 64 / block_size;
  parameters.pool_mib = 32;
  return parameters;
}

// Sets the blocks' states as fusion leaves them.
inline void setBlockStates(BlockMap& map) {
  const MapParameters& parameters = map.parameters();
  const double near_surface = std::sqrt(3.0) * parameters.voxel_size_m * TSDF_MAX / parameters.truncation_m;
  const MapContent content = readMap(map);
  std::vector<int> states(map.slots().bound(), 0);
  const int m = parameters.block_size;
  for (const SlotTable::Block& block : map.slots().blocks()) {
    const auto& distances = content.at(keyOf(block.index)).distances;
    for (int voxel = 0; voxel < m * m * m; ++voxel) {
      if (distances[voxel] == TSDF_CHI) continue;
      states[block.slot] |= BLOCK_HAS_DATA;
      if (std::abs(distances[voxel]) > near_surface) continue;
      const int octant =
          voxel % m / (m / 2) + 2 * (voxel / m % m / (m / 2)) + 4 * (voxel / (m * m) / (m / 2));
      states[block.slot] |= 1 << (octant + BLOCK_NEAR_SURFACE_SHIFT);
    }
  }
  map.blockStates().write(states);
}

// Makes a map with the surface in the whole window, centred on the point.
inline std::unique_ptr<BlockMap> makeMap(const MapParameters& parameters, const SignedDistance& distance,
                                         const Eigen::Vector3d& centre_W = Eigen::Vector3d::Zero()) {
  auto map = std::make_unique<BlockMap>(compute(), parameters);
  map->reset(centre_W);
  fillMap(*map, distance, map->window().origin, parameters.blocks_per_axis);
  setBlockStates(*map);
  return map;
}

struct Images {
  cv::Mat depth, normals;
};

inline Images render(BlockMap& map, const Pose& T_W_D, float max_range_m = kMaxRange_m,
                     const std::string& renderer_name = "ray_casting") {
  ModelViewRenderer renderer(compute(), map, kCamera, {renderer_name});
  StageTimers timers;
  const ModelView& view = renderer.render(T_W_D, kMinRange_m, max_range_m, timers);
  EXPECT_TRUE(view.T_W_D.isApprox(T_W_D));
  return {readImage(view.depth, kCamera), readNormals(view.normals, kCamera)};
}

inline Eigen::Vector3d rayThrough(int x, int y) {
  return {(x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1.0};
}

inline Pose lookingAt(const Eigen::Vector3d& target, const Eigen::Vector3d& from, double roll_rad) {
  const Eigen::Vector3d forward = (target - from).normalized();
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), forward) *
                   Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()))
                      .toRotationMatrix();
  pose.translation() = from;
  return pose;
}

inline const Eigen::Vector3d kCentre(0.013, -0.027, 0.041);
constexpr double kRadius_m = 0.25;

inline double sphereDistance(const Eigen::Vector3d& p) { return (p - kCentre).norm() - kRadius_m; }

// Holds the errors of a rendered sphere where it is seen at an angle that is not flat, and the hits where
// there is no sphere.
struct ViewErrors {
  size_t hits = 0, missing = 0, false_hits = 0;
  double mean_vox = 0.0, largest_vox = 0.0, largest_angle_rad = 0.0;
};

inline ViewErrors compareWithSphere(const Images& view, const Pose& T_W_D, double voxel_size_m) {
  ViewErrors errors;
  const Eigen::Vector3d centre_D = T_W_D.inverse() * kCentre;
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      const Eigen::Vector3d ray = rayThrough(x, y).normalized();
      const double depth = view.depth.at<float>(y, x);
      const double along = centre_D.dot(ray);
      const double off = (centre_D - along * ray).norm();
      if (off > kRadius_m + voxel_size_m) errors.false_hits += depth > 0.0;
      if (off > 0.9 * kRadius_m) continue;
      ++errors.hits;
      errors.missing += depth == 0.0;
      const double range = along - std::sqrt(kRadius_m * kRadius_m - off * off);
      const double error_vox = std::abs(depth / ray.z() - range) / voxel_size_m;
      const cv::Vec3f n = view.normals.at<cv::Vec3f>(y, x);
      const Eigen::Vector3d truth = (range * ray - centre_D) / kRadius_m;
      const double cosine = truth.dot(Eigen::Vector3d(n[0], n[1], n[2]));
      errors.mean_vox += error_vox;
      errors.largest_vox = std::max(errors.largest_vox, error_vox);
      errors.largest_angle_rad = std::max(errors.largest_angle_rad, std::acos(std::min(cosine, 1.0)));
    }
  }
  errors.mean_vox /= errors.hits;
  return errors;
}

// `render` makes Images from a map, a pose and the largest range.
template <class Render>
void expectNothingOutOfRange(const Render& render) {
  const auto map = makeMap(mapParameters(8), sphereDistance);
  const Pose outside = lookingAt(kCentre, Eigen::Vector3d(0.0, 0.0, -1.5), 0.0);
  EXPECT_EQ(cv::countNonZero(render(*map, outside, 1.0f).depth), 0);
  const Pose away = lookingAt(Eigen::Vector3d(0.0, 0.0, -3.0), Eigen::Vector3d(0.0, 0.0, -1.5), 0.0);
  const Images view = render(*map, away, kMaxRange_m);
  EXPECT_EQ(cv::countNonZero(view.depth), 0);
  EXPECT_EQ(cv::countNonZero(view.normals.reshape(1)), 0);
}

}  // namespace depth_fusion
