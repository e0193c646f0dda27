#include "loops/feature_alignment.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "shared/types.h"
#include "texture_odometry/brief.h"
#include "texture_odometry/feature_depth.h"
#include "texture_odometry/motion_estimation.h"

namespace depth_fusion {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCornerSigma_px = 1.0;
constexpr int kMaxSamples = 300;
constexpr InlierGate kGate{4.0, 4.0};

struct Nearest {
  int index = -1;
  int distance = 257, next_distance = 257;

  void offer(int candidate, int candidate_distance) {
    if (candidate_distance < distance) {
      *this = {candidate, candidate_distance, distance};
    } else if (candidate_distance < next_distance) {
      next_distance = candidate_distance;
    }
  }

  bool isClear(const LoopParameters& parameters) const {
    return index >= 0 && distance <= parameters.max_descriptor_distance &&
           static_cast<float>(distance) <=
               parameters.max_descriptor_ratio * static_cast<float>(next_distance);
  }
};

// Twice as far away is a level of the pyramid less.
bool mayBeTheSame(const Feature& a, const Feature& b) { return std::abs(a.level - b.level) <= 1; }

Sighting sightingOf(const Feature& feature, const FrameFeatures& frame) {
  Sighting sighting{fullImagePixel(feature.pixel, feature.level), std::nullopt, 0.0};
  if (!feature.surface_C) return sighting;
  const Vector3d ray = rayThrough(frame.camera, sighting.pixel);
  const double inverse_z = feature.surface_C->dot(ray);
  if (!(inverse_z > 0.0)) return sighting;
  sighting.point = ray / inverse_z;
  sighting.depth_sigma_m = AXIAL_SIGMA_M(frame.depth_sensor, sighting.point->z());
  return sighting;
}

std::vector<Correspondence> pairsOf(const FrameFeatures& old_features, const FrameFeatures& new_features,
                                    const LoopParameters& parameters) {
  const std::vector<Feature>&a = old_features.features, &b = new_features.features;
  std::vector<Nearest> of_old(a.size()), of_new(b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t j = 0; j < b.size(); ++j) {
      if (!mayBeTheSame(a[i], b[j])) continue;
      const int distance = hammingDistance(a[i].descriptor, b[j].descriptor);
      of_old[i].offer(static_cast<int>(j), distance);
      of_new[j].offer(static_cast<int>(i), distance);
    }
  }
  std::vector<Correspondence> pairs;
  for (size_t j = 0; j < b.size(); ++j) {
    if (!of_new[j].isClear(parameters)) continue;
    const auto i = static_cast<size_t>(of_new[j].index);
    if (of_old[i].index != static_cast<int>(j) || !of_old[i].isClear(parameters)) continue;
    const int level = std::max(a[i].level, b[j].level);
    const Correspondence pair{sightingOf(a[i], old_features), sightingOf(b[j], new_features),
                              kCornerSigma_px * (1 << level)};
    if (pair.hasDepth()) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace

FeatureAlignment alignFeatures(const FrameFeatures& old_features, const FrameFeatures& new_features,
                               const LoopParameters& parameters) {
  FeatureAlignment result;
  const std::vector<Correspondence> pairs = pairsOf(old_features, new_features, parameters);
  result.matches = static_cast<int>(pairs.size());
  if (result.matches < parameters.min_inliers) return result;
  const MotionCameras cameras{old_features.camera, new_features.camera};
  std::optional<MotionEstimate> motion = estimateByRansac(pairs, cameras, kGate, kMaxSamples);
  if (motion) motion = refineMotion(pairs, cameras, kGate, motion->T_reference_current);
  if (!motion) return result;
  result.inliers = static_cast<int>(motion->inliers.size());
  if (result.inliers < parameters.min_inliers || !motion->covariance.allFinite()) return result;
  const Pose T_D_C = old_features.T_C_D.inverse();
  const Matrix6d to_depth = adjoint(T_D_C);
  result.T_old_new = orthonormalized(T_D_C * motion->T_reference_current * new_features.T_C_D);
  result.covariance = to_depth * motion->covariance * to_depth.transpose();
  result.is_found = true;
  return result;
}

}  // namespace depth_fusion
