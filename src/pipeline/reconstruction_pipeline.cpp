#include "depth_fusion/pipeline/reconstruction_pipeline.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

// The window's middle lies ahead of the camera, where the scene is, but keeps the camera well inside.
Eigen::Vector3d windowCentre(const MapParameters& map, const Pose& T_W_D) {
  const double window_m = static_cast<double>(map.voxel_size_m) * map.block_size * map.blocks_per_axis;
  const double ahead_m = std::min(0.35 * window_m, 2.0);
  return T_W_D * Eigen::Vector3d(0.0, 0.0, ahead_m);
}

}  // namespace

ParameterTable PipelineParameters::table() {
  ParameterTable all;
  for (const auto& [stage, table] :
       {std::make_pair("map", map.table()), std::make_pair("preprocessing", preprocessing.table()),
        std::make_pair("texture_odometry", texture_odometry.table()),
        std::make_pair("icp_tracking", icp_tracking.table()), std::make_pair("tsdf_fusion", tsdf_fusion.table()),
        std::make_pair("surface_mesh", surface_mesh.table())}) {
    const ParameterTable rows = withPrefix(stage, table);
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

ReconstructionPipeline::ReconstructionPipeline(ComputeContext& compute, const PipelineParameters& parameters,
                                               const CameraIntrinsics& camera)
    : compute_(compute),
      parameters_(parameters),
      map_(compute, parameters.map),
      preprocessor_(compute, parameters.preprocessing, camera),
      odometry_(parameters.texture_odometry),
      tracker_(compute, parameters.icp_tracking, camera),
      fusion_(compute, map_, parameters.tsdf_fusion),
      renderer_(compute, map_, camera) {}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  const DepthFrame& depth = preprocess(frame);
  const MotionPrior motion = prior(frame);
  result.tracking = view_ == nullptr ? begin(frame) : tracker_.track(depth, *view_, motion, timers_);
  if (result.tracking.status == TrackingStatus::kLost) return result;
  result.fusion = fuse(depth, result.tracking.T_W_D);
  previous_ = {result.tracking.T_W_D, std::nullopt};
  view_ = &renderer_.render(result.tracking.T_W_D, parameters_.preprocessing.min_range_m,
                            parameters_.preprocessing.max_range_m, timers_);
  return result;
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame, const Pose& T_W_D) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  const DepthFrame& depth = preprocess(frame);
  result.tracking.status = TrackingStatus::kTracking;
  result.tracking.T_W_D = T_W_D;
  result.fusion = fuse(depth, T_W_D);
  if (result.fusion.blocks_updated == 0) {
    result.tracking.status = TrackingStatus::kLost;
    result.tracking.reason = "no depth in range";
  }
  return result;
}

const DepthFrame& ReconstructionPipeline::preprocess(const RgbdFrame& frame) {
  const StageTimers::Scope timer(timers_, "preprocessing");
  const DepthFrame& depth = preprocessor_.process(frame);
  compute_.finish();
  return depth;
}

MotionPrior ReconstructionPipeline::prior(const RgbdFrame& frame) {
  const StageTimers::Scope timer(timers_, "texture_odometry");
  const TextureOdometryResult motion = odometry_.process(frame);
  if (!motion.found) return previous_;
  const Matrix6d to_world = adjoint(previous_.T_W_D);
  previous_.T_W_D = orthonormalized(previous_.T_W_D * motion.T_previous_current);
  MotionPrior result = previous_;
  const double scale = std::pow(parameters_.texture_odometry.sigma_scale, 2);
  result.covariance = scale * to_world * motion.covariance * to_world.transpose();
  return result;
}

TrackingResult ReconstructionPipeline::begin(const RgbdFrame& frame) const {
  cv::Mat in_range;
  cv::inRange(frame.depth, parameters_.preprocessing.min_range_m / frame.depth_unit_m,
              parameters_.preprocessing.max_range_m / frame.depth_unit_m, in_range);
  const int points = cv::countNonZero(in_range);
  TrackingResult first;
  if (points < parameters_.icp_tracking.min_inliers) {
    first.reason = "only " + std::to_string(points) + " points with depth in range to begin with";
  } else {
    first.status = TrackingStatus::kTracking;
  }
  return first;
}

FusionResult ReconstructionPipeline::fuse(const DepthFrame& depth, const Pose& T_W_D) {
  if (map_.usage().blocks == 0) map_.reset(windowCentre(parameters_.map, T_W_D));
  return fusion_.integrate(depth, T_W_D, timers_);
}

}  // namespace depth_fusion
