#include "depth_fusion/pipeline/reconstruction_pipeline.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

// A longer gap says nothing about how fast the sensor moves now.
constexpr double kMaxVelocityGap_s = 0.25;

Vector6d velocityOver(const Pose& T_before_now, double seconds) {
  if (!(seconds > 0.0 && seconds < kMaxVelocityGap_s)) return Vector6d::Zero();
  return twistFromPose(T_before_now) / seconds;
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
        std::make_pair("icp_tracking", icp_tracking.table()),
        std::make_pair("relocalisation", relocalisation.table()), std::make_pair("tsdf_fusion", tsdf_fusion.table()),
        std::make_pair("color_fusion", color_fusion.table()), std::make_pair("surface_mesh", surface_mesh.table())}) {
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
      relocaliser_(parameters.relocalisation),
      fusion_(compute, map_, parameters.tsdf_fusion),
      renderer_(compute, map_, camera) {
  parameters_.map = map_.parameters();
  if (parameters.map.color) color_fusion_ = std::make_unique<ColorFusion>(compute, map_, parameters.color_fusion);
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  const MotionPrior prior = predict(frame);
  const DepthFrame& depth = preprocess(frame);
  result.tracking = track(frame, depth, prior);
  if (result.tracking.status != TrackingStatus::kLost) fuse(frame, depth, result);
  if (result.tracking.status == TrackingStatus::kLost) {
    tracked_.reset();
    return result;
  }
  follow(frame, result.tracking.T_W_D);
  relocaliser_.add(odometry_.previous(), result.tracking.T_W_D);
  view_ = &render(result.tracking.T_W_D);
  return result;
}

FrameResult ReconstructionPipeline::processFrame(const RgbdFrame& frame, const Pose& T_W_D) {
  const StageTimers::Scope timer(timers_, "frame");
  FrameResult result;
  follow(frame, T_W_D);
  const DepthFrame& depth = preprocess(frame);
  result.tracking.status = TrackingStatus::kTracking;
  result.tracking.T_W_D = T_W_D;
  fuse(frame, depth, result);
  return result;
}

MotionPrior ReconstructionPipeline::predict(const RgbdFrame& frame) {
  const double since_last_s = frame.stamp_s - std::exchange(stamp_s_, frame.stamp_s);
  if (!tracked_) velocity_.setZero();
  if (!parameters_.texture_odometry.enabled) return {T_W_expected_, std::nullopt};
  const StageTimers::Scope timer(timers_, "texture_odometry");
  const TextureOdometryResult motion = odometry_.process(frame);
  if (!motion.found) return {T_W_expected_, std::nullopt};
  const MotionPrior prior = motion.priorFrom(T_W_expected_);
  velocity_ = velocityOver(motion.T_previous_current, since_last_s);
  T_W_expected_ = prior.T_W_D;
  return prior;
}

const DepthFrame& ReconstructionPipeline::preprocess(const RgbdFrame& frame) {
  const StageTimers::Scope timer(timers_, "preprocessing");
  const DepthFrame& depth = preprocessor_.process(frame, velocity_);
  compute_.finish();
  return depth;
}

TrackingResult ReconstructionPipeline::track(const RgbdFrame& frame, const DepthFrame& depth,
                                             const MotionPrior& prior) {
  if (view_ == nullptr) return begin(frame);
  TrackingResult result;
  if (tracked_) result = tracker_.track(depth, *view_, prior, timers_);
  return result.status == TrackingStatus::kLost ? relocalise(depth, prior, result) : result;
}

TrackingResult ReconstructionPipeline::relocalise(const DepthFrame& depth, const MotionPrior& prior,
                                                  const TrackingResult& lost) {
  const StageTimers::Scope timer(timers_, "relocalisation");
  const FrameFeatures& features = odometry_.previous();
  for (const Keyframe* keyframe : relocaliser_.candidates(features)) {
    const TextureOdometryResult motion = odometry_.match(keyframe->features, features, true);
    if (!motion.found) continue;
    const TrackingResult result = trackFrom(motion.priorFrom(keyframe->T_W_D), depth);
    if (result.status != TrackingStatus::kLost) return result;
  }
  return tracked_ ? lost : trackFrom(prior, depth);
}

TrackingResult ReconstructionPipeline::trackFrom(const MotionPrior& prior, const DepthFrame& depth) {
  TrackingResult result = tracker_.track(depth, render(prior.T_W_D), prior, timers_);
  if (result.status == TrackingStatus::kLost ||
      result.inlier_fraction >= parameters_.relocalisation.min_inlier_fraction) {
    return result;
  }
  result.status = TrackingStatus::kLost;
  result.reason = "still lost: only " + std::to_string(std::lround(100.0 * result.inlier_fraction)) +
                  " % of the points fit the map";
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
  if (color_fusion_) {
    result.color = color_fusion_->integrate(frame, depth, tracking.T_W_D, fusion_.visibleBlocks(),
                                            result.fusion.blocks_updated, timers_);
  }
  if (result.fusion.blocks_updated > 0) return;
  tracking.status = TrackingStatus::kLost;
  tracking.reason = "no depth in range and in the map's window; see map/blocks_per_axis and preprocessing/max_range_m";
}

void ReconstructionPipeline::follow(const RgbdFrame& frame, const Pose& T_W_D) {
  velocity_.setZero();
  if (tracked_) velocity_ = velocityOver(tracked_->T_W_D.inverse() * T_W_D, frame.stamp_s - tracked_->stamp_s);
  tracked_ = {frame.stamp_s, T_W_D};
  T_W_expected_ = T_W_D;
}

const ModelView& ReconstructionPipeline::render(const Pose& T_W_D) {
  return renderer_.render(T_W_D, parameters_.preprocessing.min_range_m, parameters_.preprocessing.max_range_m, timers_);
}

}  // namespace depth_fusion
