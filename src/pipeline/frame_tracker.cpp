#include "depth_fusion/pipeline/frame_tracker.h"

#include <cmath>
#include <utility>

#include "pipeline/depth_in_range.h"
#include "pipeline/preprocessing_step.h"

namespace depth_fusion {

FrameTracker::FrameTracker(ComputeContext& compute, const PipelineParameters& parameters,
                           const CameraIntrinsics& camera, RenderView render)
    : compute_(compute),
      parameters_(withinSensorRange(parameters)),
      render_(std::move(render)),
      preprocessor_(compute, parameters.preprocessing, camera, parameters.depth_sensor),
      tracker_(compute, parameters.icp_tracking, camera),
      relocaliser_(parameters.relocalisation),
      matcher_(parameters.texture_odometry, parameters.depth_sensor) {}

void FrameTracker::setParameters(const PipelineParameters& parameters) {
  preprocessor_.setParameters(parameters.preprocessing, parameters.depth_sensor);
  tracker_.setParameters(parameters.icp_tracking);
  relocaliser_.setParameters(parameters.relocalisation);
  matcher_.setParameters(parameters.texture_odometry, parameters.depth_sensor);
  parameters_ = withinSensorRange(parameters);
}

MotionPrior FrameTracker::prepare(const RgbdFrame& frame, const TextureOdometryResult& motion,
                                  StageTimers& timers) {
  const MotionPrior prior = predict(frame.stamp_s, motion);
  preprocess(compute_, preprocessor_, frame, velocity_, timers);
  return prior;
}

TrackingResult FrameTracker::track(const RgbdFrame& frame, const MotionPrior& prior,
                                   const FrameFeatures& features, const ModelView* view, StageTimers& timers,
                                   const Pose& start) {
  if (view == nullptr) return begin(frame, start);
  const DepthFrame& depth = *preprocessor_.result();
  TrackingResult result;
  if (tracked_) result = tracker_.track(depth, *view, prior, timers);
  return result.status == TrackingStatus::kLost ? relocalise(depth, features, prior, result, timers) : result;
}

void FrameTracker::accept(const RgbdFrame& frame, const FrameFeatures& features, const Pose& T_W_D) {
  moveTo(frame.stamp_s, T_W_D);
  relocaliser_.add(features, T_W_D);
}

void FrameTracker::follow(const RgbdFrame& frame, const Pose& T_W_D, StageTimers& timers) {
  moveTo(frame.stamp_s, T_W_D);
  preprocess(compute_, preprocessor_, frame, velocity_, timers);
}

void FrameTracker::moveTo(double stamp_s, const Pose& T_W_D) {
  velocity_.setZero();
  if (tracked_) velocity_ = velocityOver(tracked_->T_W_D.inverse() * T_W_D, stamp_s - tracked_->stamp_s);
  tracked_ = {stamp_s, T_W_D};
  T_W_expected_ = T_W_D;
}

void FrameTracker::reject() { tracked_.reset(); }

void FrameTracker::skip(double stamp_s, const TextureOdometryResult& motion) { predict(stamp_s, motion); }

void FrameTracker::reset() {
  relocaliser_.reset();
  tracked_.reset();
  T_W_expected_ = Pose::Identity();
  velocity_.setZero();
}

void FrameTracker::expectAt(const Pose& T_W_D) {
  reject();
  T_W_expected_ = T_W_D;
}

MotionPrior FrameTracker::predict(double stamp_s, const TextureOdometryResult& motion) {
  const double since_last_s = stamp_s - std::exchange(stamp_s_, stamp_s);
  if (!tracked_) velocity_.setZero();
  if (!motion.found) return {T_W_expected_, std::nullopt};
  const MotionPrior prior = motion.priorFrom(T_W_expected_);
  velocity_ = velocityOver(motion.T_previous_current, since_last_s);
  T_W_expected_ = prior.T_W_D;
  return prior;
}

TrackingResult FrameTracker::begin(const RgbdFrame& frame, const Pose& start) const {
  const int points = cv::countNonZero(depthInRange(frame, parameters_.preprocessing));
  TrackingResult first;
  if (points < parameters_.icp_tracking.min_inliers) {
    first.reason = "only " + std::to_string(points) + " points with depth in range to begin with";
  } else {
    first.status = TrackingStatus::kTracking;
    first.T_W_D = start;
  }
  return first;
}

TrackingResult FrameTracker::relocalise(const DepthFrame& depth, const FrameFeatures& features,
                                        const MotionPrior& prior, const TrackingResult& lost,
                                        StageTimers& timers) {
  const StageTimers::Scope timer(timers, "relocalisation");
  for (const Keyframe* keyframe : relocaliser_.candidates(features)) {
    const TextureOdometryResult motion = matcher_.match(keyframe->features, features, true);
    if (!motion.found) continue;
    const TrackingResult result = trackFrom(motion.priorFrom(keyframe->T_W_D), depth, timers);
    if (result.status != TrackingStatus::kLost) return result;
  }
  return tracked_ ? lost : trackFrom(prior, depth, timers);
}

TrackingResult FrameTracker::trackFrom(const MotionPrior& prior, const DepthFrame& depth,
                                       StageTimers& timers) {
  TrackingResult result = tracker_.track(depth, render_(prior.T_W_D), prior, timers);
  if (result.status == TrackingStatus::kLost ||
      result.inlier_fraction >= parameters_.relocalisation.min_inlier_fraction) {
    return result;
  }
  result.status = TrackingStatus::kLost;
  result.reason = "still lost: only " + std::to_string(std::lround(100.0 * result.inlier_fraction)) +
                  " % of the points fit the map";
  return result;
}

}  // namespace depth_fusion
