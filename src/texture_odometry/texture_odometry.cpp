#include "depth_fusion/texture_odometry/texture_odometry.h"

#include <algorithm>
#include <cmath>

#include "shared/types.h"
#include "texture_odometry/feature_depth.h"
#include "texture_odometry/feature_detection.h"
#include "texture_odometry/feature_matching.h"
#include "texture_odometry/motion_estimation.h"
#include "texture_odometry/patch_alignment.h"

namespace depth_fusion {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A corner is found to about a pixel of its level; its patch is aligned to a fraction of one.
constexpr double kCornerSigma_px = 1.0;

// Returns what the frame's camera sees of the feature at the given pixel of the full image.
Sighting sightingOf(const Feature& feature, const FrameFeatures& frame, const Vector2d& pixel) {
  Sighting sighting{pixel, std::nullopt, 0.0};
  if (!feature.surface_C) return sighting;
  const Vector3d ray = rayThrough(frame.camera, pixel);
  const double inverse_z = feature.surface_C->dot(ray);
  if (!(inverse_z > 0.0)) return sighting;
  sighting.point = ray / inverse_z;
  sighting.depth_sigma_m = AXIAL_SIGMA_M(frame.depth_sensor, sighting.point->z());
  return sighting;
}

// Returns the pairs with depth in at least one of the frames, at the corners' pixels.
std::vector<Correspondence> correspondencesOf(const FrameFeatures& reference, const FrameFeatures& current,
                                              std::vector<FeatureMatch>& matches) {
  std::vector<Correspondence> result;
  std::vector<FeatureMatch> kept;
  for (const FeatureMatch& match : matches) {
    const Feature& a = reference.features[match.reference];
    const Feature& b = current.features[match.current];
    result.push_back({sightingOf(a, reference, fullImagePixel(a.pixel, a.level)),
                      sightingOf(b, current, fullImagePixel(b.pixel, b.level)),
                      kCornerSigma_px * (1 << a.level)});
    if (result.back().hasDepth()) {
      kept.push_back(match);
    } else {
      result.pop_back();
    }
  }
  matches = std::move(kept);
  return result;
}

// Moves the current pixel of each indexed pair to where the reference's patch fits, and drops the pairs that
// fit nowhere.
std::vector<Correspondence> alignPatches(const FrameFeatures& reference, const FrameFeatures& current,
                                         const std::vector<FeatureMatch>& matches,
                                         const std::vector<Correspondence>& pairs,
                                         const std::vector<size_t>& indices) {
  std::vector<Correspondence> aligned;
  for (const size_t index : indices) {
    const Feature& a = reference.features[matches[index].reference];
    const Feature& b = current.features[matches[index].current];
    const std::optional<Vector2d> level_pixel =
        alignPatch(a.patch, current.smoothed_levels[b.level], Vector2d(b.pixel.x, b.pixel.y));
    if (!level_pixel) continue;
    Correspondence pair = pairs[index];
    const cv::Point2d pixel(level_pixel->x(), level_pixel->y());
    pair.current = sightingOf(b, current, fullImagePixel(pixel, b.level));
    if (pair.hasDepth()) aligned.push_back(pair);
  }
  return aligned;
}

int inlierCount(const std::optional<MotionEstimate>& motion) {
  return motion ? static_cast<int>(motion->inliers.size()) : 0;
}

// Turns the colour camera's motion into the depth camera's.
void setMotion(const MotionEstimate& estimate, const FrameFeatures& reference, const FrameFeatures& current,
               TextureOdometryResult& result) {
  const Pose T_D_C = reference.T_C_D.inverse();
  result.T_previous_current = orthonormalized(T_D_C * estimate.T_reference_current * current.T_C_D);
  const Matrix6d to_depth = adjoint(T_D_C);
  result.covariance = to_depth * estimate.covariance * to_depth.transpose();
}

}  // namespace

TextureOdometry::TextureOdometry(const TextureOdometryParameters& parameters,
                                 const DepthSensorParameters& sensor)
    : parameters_(parameters), sensor_(sensor) {
  validate(parameters_.table());
  reset();
}

void TextureOdometry::setParameters(const TextureOdometryParameters& parameters,
                                    const DepthSensorParameters& sensor) {
  validate(TextureOdometryParameters(parameters).table());
  parameters_ = parameters;
  sensor_ = sensor;
}

void TextureOdometry::reset() {
  previous_ = {};
  previous_.reason = "the first frame";
}

TextureOdometryResult TextureOdometry::process(const RgbdFrame& frame) {
  FrameFeatures current = extract(frame);
  TextureOdometryResult result = match(previous_, current);
  previous_ = std::move(current);
  return result;
}

TexturedFrame TextureOdometry::texture(const RgbdFrame& frame, StageTimers& timers) {
  if (!parameters_.enabled) {
    reset();
    return withoutTexture("texture_odometry/enabled is false");
  }
  const StageTimers::Scope timer(timers, "texture_odometry");
  const TextureOdometryResult motion = process(frame);
  return {previous_, motion};
}

FrameFeatures TextureOdometry::extract(const RgbdFrame& frame) const {
  FrameFeatures result;
  result.camera = colorCamera(frame);
  result.T_C_D = frame.T_C_D.value_or(Pose::Identity());
  result.depth_sensor = sensor_;
  result.reason = colorProblem(frame);
  if (!result.reason.empty()) return result;
  detectFeatures(frame.color, parameters_, result);
  findSurfaces(frame, result);
  const int count = static_cast<int>(result.features.size());
  if (count < parameters_.min_features) result.reason = "only " + std::to_string(count) + " features";
  return result;
}

TextureOdometryResult TextureOdometry::match(const FrameFeatures& reference, const FrameFeatures& current,
                                             bool anywhere_in_image) const {
  TextureOdometryResult result;
  result.features = static_cast<int>(current.features.size());
  result.reason = current.reason;
  if (result.reason.empty() && !reference.reason.empty()) result.reason = "reference: " + reference.reason;
  if (!result.reason.empty()) return result;

  const double radius_px = anywhere_in_image ? 1e6 : parameters_.search_radius_px;
  std::vector<FeatureMatch> matches =
      matchFeatures(reference.features, current.features, radius_px, parameters_.max_descriptor_distance);
  const std::vector<Correspondence> pairs = correspondencesOf(reference, current, matches);
  result.matches = static_cast<int>(pairs.size());
  if (result.matches < parameters_.min_matches) {
    result.reason = "only " + std::to_string(result.matches) + " matches with depth";
    return result;
  }

  const float fraction_needed = parameters_.min_inlier_fraction * static_cast<float>(result.matches);
  const int needed = std::max(parameters_.min_inliers, static_cast<int>(std::ceil(fraction_needed)));
  const MotionCameras cameras{reference.camera, current.camera};
  std::optional<MotionEstimate> motion =
      estimateByRansac(pairs, cameras, {parameters_.coarse_inlier_px, parameters_.inlier_depth_sigmas},
                       parameters_.ransac_iterations);
  if (inlierCount(motion) >= needed) {
    motion = refineMotion(alignPatches(reference, current, matches, pairs, motion->inliers), cameras,
                          {parameters_.fine_inlier_px, parameters_.inlier_depth_sigmas},
                          motion->T_reference_current, parameters_.shared_error);
  }
  result.inliers = inlierCount(motion);
  if (result.inliers < needed) {
    result.reason =
        "only " + std::to_string(result.inliers) + " inliers of " + std::to_string(result.matches);
    return result;
  }
  setMotion(*motion, reference, current, result);
  result.found = true;
  return result;
}

}  // namespace depth_fusion
