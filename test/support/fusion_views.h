// What the tests of fusion look at: views of a bumpy wall, and the map's voxels.
#pragma once

#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"
#include "reference/tsdf_fusion.h"
#include "support/device_frames.h"
#include "support/test_compute.h"

namespace depth_fusion {

using reference::Measurement;
using reference::View;
using reference::Voxel;

constexpr CameraIntrinsics kCamera{101, 74, 90.0, 92.0, 49.3, 37.1};

inline MapParameters mapParameters(int block_size = 8, int blocks_per_axis = 32, float voxel_size_m = 0.02f) {
  MapParameters parameters;
  parameters.voxel_size_m = voxel_size_m;
  parameters.truncation_m = 3.0f * voxel_size_m;
  parameters.block_size = block_size;
  parameters.blocks_per_axis = blocks_per_axis;
  parameters.pool_mib = 64;
  return parameters;
}

inline cv::Mat wallDepth(double z_m) {
  return cv::Mat(kCamera.height, kCamera.width, CV_32FC1, cv::Scalar(z_m));
}

// Makes a bumpy wall with a hole, and a box in front of it.
inline cv::Mat bumpyDepth(double z_m) {
  cv::Mat depth = wallDepth(z_m);
  reference::forEachPixel<float>(depth, [&](int x, int y, float& pixel) {
    pixel += static_cast<float>(0.1 * std::sin(0.13 * x) + 0.002 * y);
    if (x > 20 && x < 40 && y > 20 && y < 50) pixel -= 0.4f;
    if (x > 60 && x < 70) pixel = 0.0f;
  });
  return depth;
}

inline Pose somePose(double scale = 1.0) {
  Vector6d twist;
  twist << 0.2, -0.3, 0.15, 0.11, 0.07, -0.23;
  return poseFromTwist(scale * twist);
}

inline View viewOf(const cv::Mat& depth, const Pose& T_W_D = Pose::Identity(),
                   const CameraIntrinsics& camera = kCamera) {
  const cv::Mat normals = quantisedNormals(reference::computeNormals(depth, camera, 0.05));
  return {camera, T_W_D, depth, normals,
          quantised(reference::measurements(depth, normals, cv::Mat(), camera))};
}

inline DepthFrame frameOf(const View& view) {
  return frameOfDepth(compute(), view.camera, view.depth, view.normals, view.measurements);
}

inline FusionResult integrate(TsdfFusion& fusion, const View& view) {
  StageTimers timers;
  return fusion.integrate(frameOf(view), view.T_W_D, timers);
}

inline Eigen::Vector3i voxelOf(const BlockIndex& block, int number, int m) {
  return m * block + Eigen::Vector3i(number % m, number / m % m, number / m / m);
}

inline Voxel voxelOf(const BlockContent& content, size_t number) {
  Voxel voxel;
  voxel.known = content.distances[number] != TSDF_CHI;
  voxel.steps = content.distances[number];
  voxel.certainty = content.certainties[number];
  return voxel;
}

}  // namespace depth_fusion
