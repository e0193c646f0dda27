#include "depth_fusion/pipeline/reconstruction_pipeline.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

// Where the depth in range is.
cv::Mat inRange(const RgbdFrame& frame, const PreprocessingParameters& parameters) {
  cv::Mat mask;
  cv::inRange(frame.depth, parameters.min_range_m / frame.depth_unit_m, parameters.max_range_m / frame.depth_unit_m,
              mask);
  return mask;
}

// The window's middle lies ahead of the camera, at the mean depth of what it sees first.
Eigen::Vector3d windowCentre(const RgbdFrame& frame, const PreprocessingParameters& parameters, const Pose& T_W_D) {
  const double ahead_m = frame.depth_unit_m * cv::mean(frame.depth, inRange(frame, parameters))[0];
  return T_W_D * Eigen::Vector3d(0.0, 0.0, ahead_m);
}

// Where the sensor's noise limits the range, every stage goes by it.
PipelineParameters withinSensorRange(PipelineParameters parameters) {
  float& max_range_m = parameters.preprocessing.max_range_m;
  max_range_m = std::min(max_range_m, parameters.depth_sensor.maxRange_m());
  return parameters;
}

}  // namespace

ParameterTable PipelineParameters::table() {
  ParameterTable all;
  for (const auto& [stage, table] :
       {std::make_pair("map", map.table()), std::make_pair("depth_sensor", depth_sensor.table()),
        std::make_pair("preprocessing", preprocessing.table()),
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
      parameters_(withinSensorRange(parameters)),
      map_(compute, parameters.map),
      preprocessor_(compute, parameters.preprocessing, camera, parameters.depth_sensor),
      odometry_(parameters.texture_odometry),
      tracker_(compute, parameters.icp_tracking, camera),
      fusion_(compute, map_, parameters.tsdf_fusion),
      renderer_(compute, map_, camera) {
  parameters_.map = map_.parameters();
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  const DepthFrame& depth = preprocess(frame);
  const MotionPrior motion = prior(frame);
  result.tracking = view_ == nullptr ? begin(frame) : tracker_.track(depth, *view_, motion, timers_);
  if (result.tracking.status == TrackingStatus::kLost) return result;
  fuse(frame, depth, result);
  if (result.tracking.status == TrackingStatus::kLost) return result;
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
  fuse(frame, depth, result);
  return result;
}

const DepthFrame& ReconstructionPipeline::preprocess(const RgbdFrame& frame) {
  const StageTimers::Scope timer(timers_, "preprocessing");
  const DepthFrame& depth = preprocessor_.process(frame);
  compute_.finish();
  return depth;
}

MotionPrior ReconstructionPipeline::prior(const RgbdFrame& frame) {
  if (!parameters_.texture_odometry.enabled) return previous_;
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
  const int points = cv::countNonZero(inRange(frame, parameters_.preprocessing));
  TrackingResult first;
  if (points < parameters_.icp_tracking.min_inliers) {
    first.reason = "only " + std::to_string(points) + " points with depth in range to begin with";
  } else {
    first.status = TrackingStatus::kTracking;
  }
  return first;
}

void ReconstructionPipeline::fuse(const RgbdFrame& frame, const DepthFrame& depth, FrameResult& result) {
  TrackingResult& tracking = result.tracking;
  if (map_.usage().blocks == 0) map_.reset(windowCentre(frame, parameters_.preprocessing, tracking.T_W_D));
  result.fusion = fusion_.integrate(depth, tracking.T_W_D, timers_);
  if (result.fusion.blocks_updated > 0) return;
  tracking.status = TrackingStatus::kLost;
  tracking.reason = "no depth in range and in the map's window; see map/blocks_per_axis and preprocessing/max_range_m";
}

}  // namespace depth_fusion
