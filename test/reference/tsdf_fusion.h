// Block selection and weighted fusion of kernels/tsdf_fusion/*.cl, plainly: sample by sample and voxel by
// voxel, in double, without rounding to bytes.
#pragma once

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <set>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"
#include "shared/types.h"
#include "support/map_contents.h"

namespace depth_fusion::reference {

struct View {
  CameraIntrinsics camera;
  Pose T_W_D;
  cv::Mat depth;

  Eigen::Vector3d rayThrough(double u, double v) const {
    return {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0};
  }
};

// Blocks within `margin` blocks of a sample in the truncation bands. A negative margin leaves out the blocks
// that the samples only just meet.
inline std::set<BlockKey> blocksInBands(const View& view, const MapParameters& map, const SelectionArgs& args,
                                        double margin) {
  std::set<BlockKey> blocks;
  const double block_m = static_cast<double>(map.voxel_size_m) * map.block_size;
  for (int y = args.stride_px / 2; y < view.camera.height; y += args.stride_px) {
    for (int x = args.stride_px / 2; x < view.camera.width; x += args.stride_px) {
      const double z = view.depth.at<float>(y, x);
      if (z <= 0.0) continue;
      const Eigen::Vector3d ray_D = view.rayThrough(x, y);
      for (int i = 0; i < args.band_samples; ++i) {
        const double beyond_m = map.truncation_m * (2.0 * i / (args.band_samples - 1) - 1.0);
        const Eigen::Vector3d p =
            view.T_W_D * Eigen::Vector3d((z + beyond_m / ray_D.norm()) * ray_D) / block_m;
        const Eigen::Vector3i low = (p.array() - margin).floor().cast<int>();
        const Eigen::Vector3i high = (p.array() + margin).floor().cast<int>();
        if (margin < 0.0 && low != high) continue;
        for (const int bx : {low.x(), high.x()}) {
          for (const int by : {low.y(), high.y()}) {
            for (const int bz : {low.z(), high.z()}) blocks.insert({bz, by, bx});
          }
        }
      }
    }
  }
  return blocks;
}

// A voxel's state or what a frame says about it. Distances in steps of the distance byte.
struct Voxel {
  bool known = false;
  double steps = 0.0;
  double weight = 0.0;
};

struct Measurement {
  Voxel voxel;
  bool ambiguous = false;  // rounding may decide the pixel, or whether the voxel counts
};

// The measurement of a voxel of a block: along the rays, all through a block with the slope of the one
// through its middle.
inline Measurement measure(const View& view, const Pose& T_D_W, const MapParameters& map,
                           const FusionArgs& args, const BlockSparseMap::BlockIndex& block,
                           const Eigen::Vector3i& voxel) {
  const double margin_px = 1e-3;
  const double margin_steps = 0.02;
  const double size_m = map.voxel_size_m;
  const Eigen::Vector3d middle =
      T_D_W * Eigen::Vector3d((block.cast<double>().array() + 0.5) * (size_m * map.block_size));
  const Eigen::Vector3d p = T_D_W * Eigen::Vector3d(voxel.cast<double>() * size_m);
  Measurement result;
  if (p.z() <= 0.0) return result;
  const double u = view.camera.fx * p.x() / p.z() + view.camera.cx + 0.5;
  const double v = view.camera.fy * p.y() / p.z() + view.camera.cy + 0.5;
  result.ambiguous =
      p.z() < 1e-4 || std::abs(u - std::round(u)) < margin_px || std::abs(v - std::round(v)) < margin_px;
  if (u < 0.0 || v < 0.0 || u >= view.camera.width || v >= view.camera.height) return result;
  const double measured = view.depth.at<float>(static_cast<int>(v), static_cast<int>(u));
  if (measured <= 0.0) return result;
  const double slope = middle.norm() / std::max(middle.z(), size_m);
  const double steps = (measured - p.z()) * slope * TSDF_MAX / map.truncation_m;
  result.ambiguous = result.ambiguous || std::abs(steps + TSDF_MAX) < margin_steps;
  if (steps < -TSDF_MAX) return result;
  result.voxel.known = true;
  result.voxel.steps = std::min(steps, 2.0 * TSDF_MAX);
  result.voxel.weight =
      std::clamp<double>(args.weight_at_1m / (p.z() * p.z()), args.min_weight, args.max_measurement_weight);
  return result;
}

// Algorithm 2 of the paper; a distance above the truncation means chi.
inline Voxel fuse(const Voxel& old, const Voxel& measured, double max_weight) {
  if (!measured.known) return old;
  Voxel result = measured;
  if (old.known) {
    result.weight = old.weight + measured.weight;
    result.steps = old.steps + measured.weight / result.weight * (measured.steps - old.steps);
  }
  result.weight = std::min(result.weight, max_weight);
  result.steps = std::max(result.steps, -1.0 * TSDF_MAX);
  return result;
}

// What becomes of a voxel that is stored in bytes by rounding to the nearest.
inline Voxel roundedToNearest(Voxel voxel) {
  voxel.steps = std::floor(voxel.steps + 0.5);
  voxel.weight = std::floor(voxel.weight + 0.5);
  voxel.known = voxel.known && voxel.steps <= TSDF_MAX;
  return voxel;
}

}  // namespace depth_fusion::reference
