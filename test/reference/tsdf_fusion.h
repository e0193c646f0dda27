// Block selection and the rules of fusion of kernels/tsdf_fusion/*.cl, plainly: sample by sample and voxel by
// voxel, in double, without rounding to bytes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <set>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"
#include "reference/depth_preprocessing.h"
#include "shared/types.h"
#include "support/map_contents.h"

namespace depth_fusion::reference {

struct View {
  CameraIntrinsics camera;
  Pose T_W_D;
  cv::Mat depth;
  cv::Mat normals;
  cv::Mat measurements;  // depth, cosine, accuracy

  Eigen::Vector3d rayThrough(double u, double v) const {
    return {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0};
  }
};

// Returns the blocks within `margin` blocks of a sample in the truncation bands. A negative margin leaves out
// the blocks that the samples only just meet.
inline std::set<BlockKey> blocksInBands(const View& view, const MapParameters& map, const SelectionArgs& args,
                                        double margin) {
  std::set<BlockKey> blocks;
  const double block_m = static_cast<double>(map.voxel_size_m) * map.block_size;
  for (int y = args.stride_px / 2; y < view.camera.height; y += args.stride_px) {
    for (int x = args.stride_px / 2; x < view.camera.width; x += args.stride_px) {
      const double z = view.depth.at<float>(y, x);
      if (z <= 0.0) continue;
      if (z < args.dense_from_m && (x / args.stride_px % 2 == 1 || y / args.stride_px % 2 == 1)) continue;
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

// Holds a voxel's state: the distance in steps of the distance byte, and the certainty, neither of them
// rounded.
struct Voxel {
  bool known = false;
  double steps = 0.0;
  double certainty = 0.0;
};

// Holds what a frame says of a voxel.
struct Measurement {
  enum { kNone, kHit, kNoisyHit, kFree } kind = kNone;  // a noisy hit counts for voxels that are known
  double steps = 0.0;
  double sigma_m = 0.0;
  bool ambiguous = false;  // rounding may decide the pixel, or whether and how the voxel counts
};

struct Plane {
  bool known = false;
  double distance_m = 0.0;
  Eigen::Vector3d normal_D;
};

inline Plane planeAt(const View& view, const Eigen::Vector3d& seen_D, const Eigen::Vector3d& p_D) {
  const double u = std::floor(view.camera.fx * seen_D.x() / seen_D.z() + view.camera.cx + 0.5);
  const double v = std::floor(view.camera.fy * seen_D.y() / seen_D.z() + view.camera.cy + 0.5);
  if (u < 0.0 || v < 0.0 || u >= view.camera.width || v >= view.camera.height) return {};
  const int x = static_cast<int>(u), y = static_cast<int>(v);
  const double z = view.measurements.at<cv::Vec3f>(y, x)[0];
  const cv::Vec3f n = view.normals.at<cv::Vec3f>(y, x);
  if (z == 0.0 || n[2] == 0.0f) return {};
  const Eigen::Vector3d normal_D(n[0], n[1], n[2]);
  return {true, normal_D.dot(p_D - z * view.rayThrough(x, y)), normal_D};
}

struct Distance {
  double metres, slope;
};

inline Distance distanceTo(const View& view, const cv::Vec3f& measured, const Eigen::Vector3d& p_D,
                           double along_ray_m, const std::string& kind, double truncation_m) {
  if (kind == "projective") return {along_ray_m, 1.0};
  if (kind == "plane") return {along_ray_m * measured[1], measured[1]};
  Distance result{along_ray_m, 1.0};
  if (std::abs(along_ray_m) >= 2.0 * truncation_m) return result;
  Eigen::Vector3d seen_D = p_D;
  for (int step = 0; step < 2; ++step) {
    const Plane plane = planeAt(view, seen_D, p_D);
    if (!plane.known) break;
    result = {plane.distance_m, measured[1]};
    seen_D = p_D - plane.distance_m * plane.normal_D;
  }
  return result;
}

// Returns the measurement of a voxel of a block. All rays through a block count as long as the one through
// its middle.
inline Measurement measure(const View& view, const Pose& T_D_W, const MapParameters& map,
                           const TsdfFusionParameters& fusion, const BlockIndex& block,
                           const Eigen::Vector3i& voxel) {
  const double margin_px = 3e-3;
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
  const cv::Vec3f pixel = view.measurements.at<cv::Vec3f>(static_cast<int>(v), static_cast<int>(u));
  if (pixel[0] <= 0.0f) return result;
  const double along_ray_m = (pixel[0] - p.z()) * middle.norm() / std::max(middle.z(), size_m);
  const Distance distance = distanceTo(view, pixel, p, along_ray_m, fusion.distance, map.truncation_m);
  const double steps_per_m = TSDF_MAX / map.truncation_m;
  result.steps = distance.metres * steps_per_m;
  result.sigma_m = sensorSigma(pixel[0]) * distance.slope / pixel[2];
  const double free_steps = TSDF_MAX + fusion.free_space_sigmas * steps_per_m * result.sigma_m;
  result.ambiguous = result.ambiguous || std::abs(result.steps + TSDF_MAX) < margin_steps ||
                     std::abs(result.steps - TSDF_MAX) < margin_steps ||
                     std::abs(result.steps - free_steps) < margin_steps;
  const double noisy_steps = 2.0 * steps_per_m * result.sigma_m;
  result.ambiguous = result.ambiguous || (noisy_steps > TSDF_MAX - margin_steps &&
                                          std::abs(std::abs(result.steps) - noisy_steps) < margin_steps);
  if (std::abs(result.steps) <= noisy_steps) result.kind = Measurement::kNoisyHit;
  if (std::abs(result.steps) <= TSDF_MAX) result.kind = Measurement::kHit;
  if (result.steps > free_steps) result.kind = Measurement::kFree;
  result.steps = std::clamp(result.steps, -1.0 * TSDF_MAX, 1.0 * TSDF_MAX);
  return result;
}

// Returns the code of a variance, on a scale of the bits of floats.
inline double certaintyOf(double variance_m2) {
  const float value = static_cast<float>(variance_m2);
  int bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return static_cast<double>(VARIANCE_BITS_MAX - bits) / VARIANCE_BITS_STEP + 1.0;
}

inline double varianceOf(double certainty) {
  const int bits = VARIANCE_BITS_MAX - static_cast<int>(std::lround((certainty - 1.0) * VARIANCE_BITS_STEP));
  float variance_m2 = 0.0f;
  std::memcpy(&variance_m2, &bits, sizeof(bits));
  return variance_m2;
}

struct FilterStep {
  double gain, certainty;
};

// Returns the step of Algorithm 1, 2 or 3 of the paper.
inline FilterStep filterStep(const Voxel& old, double variance_m2, const TsdfFusionParameters& fusion) {
  const double quality = std::pow(sensorSigma(1.0), 2) / variance_m2;
  if (fusion.rule == "average") {
    if (!old.known) return {1.0, 1.0};
    return {std::min(1.0, fusion.gain_at_1m * quality), old.certainty + 1.0};
  }
  if (fusion.rule == "weighted") {
    const double weight = std::max(0.25, fusion.weight_at_1m * quality);
    const double total = weight + (old.known ? old.certainty : 0.0);
    return {weight / total, std::min<double>(total, fusion.max_weight)};
  }
  if (!old.known) return {1.0, certaintyOf(variance_m2)};
  const double predicted_m2 = varianceOf(old.certainty) + std::pow(fusion.process_sigma_m, 2);
  const double gain = predicted_m2 / (predicted_m2 + variance_m2);
  return {gain, certaintyOf((1.0 - gain) * predicted_m2)};
}

inline Voxel fuse(const Voxel& old, const Measurement& measured, const TsdfFusionParameters& fusion) {
  if (measured.kind == Measurement::kNone) return old;
  if (measured.kind == Measurement::kNoisyHit && !old.known) return old;
  Voxel result = old;
  if (measured.kind == Measurement::kFree) {
    const double kept = 1.0 - fusion.free_space_rate;
    result.certainty =
        fusion.rule == "kalman" ? certaintyOf(varianceOf(old.certainty) / kept) : old.certainty * kept;
    return result;
  }
  const FilterStep step = filterStep(old, std::pow(measured.sigma_m, 2), fusion);
  const double base = old.known ? old.steps : measured.steps;
  result.known = true;
  result.steps = std::max(base + step.gain * (measured.steps - base), -1.0 * TSDF_MAX);
  result.certainty = std::clamp(step.certainty, 1.0, 1.0 * CERTAINTY_MAX);
  return result;
}

// Returns what becomes of a voxel that is stored in bytes by rounding to the nearest.
inline Voxel roundedToNearest(Voxel voxel) {
  voxel.steps = std::floor(voxel.steps + 0.5);
  voxel.certainty = std::floor(voxel.certainty + 0.5);
  voxel.known = voxel.known && voxel.steps <= TSDF_MAX;
  return voxel;
}

}  // namespace depth_fusion::reference
