#include "depth_fusion/pipeline/tracking_session.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/preprocessing/depth_range.h"

namespace depth_fusion {
namespace {

constexpr char kWhereExpected[] =
    "; it begins where the sensor is expected, which nothing measures: poses of before are of another world";
constexpr int kAllDirections = 6;
constexpr char kGuessed[] = "; nothing measures that, and the pose stays where it was expected";

// Whether frames are compensated for the sensor's motion.
bool bendsFrames(const PreprocessingParameters& parameters) {
  return parameters.readout_s != 0.0f || parameters.stamp_delay_s != 0.0f;
}

// The sensor has moved so far since the view that another one is needed, as after a gap in the frames.
bool isFarFrom(const Pose& T_W_view, const MotionPrior& prior) {
  constexpr double kFar_m = 0.4, kFar_rad = 0.4;
  const Pose motion = T_W_view.inverse() * prior.T_W_D;
  return prior.covariance && (motion.translation().norm() > kFar_m || rotationAngle(motion) > kFar_rad);
}

std::string guessedTooLong(const GuessedMotion& motion) {
  char reason[200];
  std::snprintf(
      reason, sizeof(reason),
      "; since it was measured the sensor may have moved by %.0f mm and %.1f degrees, too far to go on",
      1e3 * motion.m(), motion.rad() * 180.0 / CV_PI);
  return reason;
}

}  // namespace

TrackingSession::TrackingSession(ComputeContext& compute, const PipelineParameters& parameters,
                                 const CameraIntrinsics& camera, RenderView render)
    : parameters_(parameters),
      render_(std::move(render)),
      preprocessor_(compute, parameters.preprocessing, camera, parameters.depth_sensor),
      tracker_(compute, parameters.icp_tracking, camera),
      drift_(parameters.drift),
      relocaliser_(parameters.relocalisation),
      matcher_(parameters.texture_odometry, parameters.depth_sensor),
      older_(compute) {}

void TrackingSession::setParameters(const PipelineParameters& parameters) {
  preprocessor_.setParameters(parameters.preprocessing, parameters.depth_sensor);
  tracker_.setParameters(parameters.icp_tracking);
  tracker_.reset();  // what is usual was so by the parameters before
  drift_.setParameters(parameters.drift);
  relocaliser_.setParameters(parameters.relocalisation);
  matcher_.setParameters(parameters.texture_odometry, parameters.depth_sensor);
  parameters_ = parameters;
}

TrackingResult TrackingSession::step(const RgbdFrame& frame, TexturedFrame texture, const ModelView* view,
                                     StageTimers& timers, const Pose& start) {
  check(!found_, "TrackingSession: the frame before is not concluded");
  if (!ahead_) prepareAhead(frame, texture, timers);
  if (view == nullptr) begun_blindly_s_.reset();
  if (view == nullptr && !ahead_->knows_motion) begun_blindly_s_ = frame.stamp_s;
  const MotionPrior predicted = takePrepared(frame);
  takeAttitude(texture.robot.attitude);
  TrackingResult result = view == nullptr ? begin(frame, begins_anew_for_.empty() ? start : predicted.T_W_D)
                                          : track(frame, predicted, texture.features, *view, timers);
  comparePriors(result);
  if (result.status != TrackingStatus::kLost) {
    learnLevel(texture.robot.attitude, result.T_W_D);
    take(frame.stamp_s, std::move(texture.features), result);
  } else {
    motion_.lose();
    noteLoss(frame, texture.features);
    if (guessed_.isTooFar()) guessed_.guess(frame.stamp_s, Vector6d::Zero());
    const bool is_guessed = result.guessed_directions > 0;  // it fits the map, somewhere
    if (!is_guessed && view != nullptr && pointsInRange(frame) >= parameters_.icp_tracking.min_inliers)
      young_map_.miss();
  }
  if (found_ && view != nullptr) compareWithOlder(frame.stamp_s, result.T_W_D, view, timers);
  result.map_doubt = mapDoubt();
  if (result.status == TrackingStatus::kLost) result.bridged = motion_.bridged();
  return result;
}

void TrackingSession::take(double stamp_s, FrameFeatures features, TrackingResult& result) {
  MotionModel unless_fused = motion_;
  const Vector6d& velocity = motion_.moveTo(stamp_s, result.T_W_D);
  if (result.guessed_directions == 0) {
    guessed_.measure(stamp_s, velocity);
  } else {
    guessed_.guess(stamp_s, velocity);
    result.reason += kGuessed;
    if (guessed_.isTooFar()) {
      motion_ = unless_fused;
      motion_.lose();
      result.status = TrackingStatus::kLost;
      result.reason += guessedTooLong(guessed_);
      return;
    }
  }
  given_.reset();
  const bool begins = result.prior == kStart || result.prior == kPartStart;
  const Matrix6d carried = result.share_of_prior * carried_ * result.share_of_prior.transpose();
  result.covariance += carried;
  if (!begins) result.covariance += drift_.ofFrame(result.T_W_D);
  result.drift = drift_.at(result.T_W_D, result.covariance);
  if (!apart_.empty()) result.drift += Matrix6d::Identity();
  found_ = {stamp_s, std::move(features), result, std::move(unless_fused),
            carried + result.covariance_of_prior};
  if (begins && !begins_anew_for_.empty()) {
    result.status = TrackingStatus::kDegenerate;
    result.guessed_directions = kAllDirections;
    result.covariance = Matrix6d::Identity();
    result.reason += kWhereExpected;
  }
}

void TrackingSession::prepareAhead(const RgbdFrame& frame, const TexturedFrame& texture,
                                   StageTimers& timers) {
  const MotionPrior prior = motion_.predict(frame.stamp_s, texture.measuredMotions());
  preprocessor_.process(frame, motion_.velocity(), timers);
  ahead_ = {frame.stamp_s, prior, preprocessor_.result(), !motion_.velocity().isZero()};
}

MotionPrior TrackingSession::takePrepared(const RgbdFrame& frame) {
  check(ahead_->stamp_s == frame.stamp_s, "TrackingSession: the frame is not the one prepared ahead");
  depth_ = std::move(ahead_->depth);
  MotionPrior prior = ahead_->prior;
  ahead_.reset();
  return prior;
}

void TrackingSession::conclude(bool fused, const RgbdFrame* pictured) {
  if (fused) {
    check(found_.has_value(), "TrackingSession: no frame is to be concluded");
    relocaliser_.add(found_->stamp_s, found_->features, found_->result.T_W_D, pictured);
    carried_ = found_->carried;
    if (drift_.add(found_->result.T_W_D, found_->result.covariance, carried_)) carried_.setZero();
    tracker_.accept(found_->result);
    const bool begins_map = found_->result.prior == kStart;
    begins_map ? young_map_.begin() : growMap();
    if (begins_map || std::exchange(begins_part_, false)) begins_anew_for_.clear();
    loss_.reset();
    watch_.add(found_->stamp_s, found_->result);
  } else {
    if (found_) {
      motion_ = found_->unless_fused;
      ahead_.reset();
    }
    motion_.lose();
  }
  found_.reset();
}

const FrameFeatures& TrackingSession::features() const {
  check(found_.has_value(), "TrackingSession: there is no frame that is not concluded");
  return found_->features;
}

void TrackingSession::follow(const RgbdFrame& frame, const Pose& T_W_D, StageTimers& timers) {
  preprocessor_.process(frame, motion_.moveTo(frame.stamp_s, T_W_D), timers);
  depth_ = preprocessor_.result();
  compareWithOlder(frame.stamp_s, T_W_D, nullptr, timers);
}

void TrackingSession::skip(double stamp_s, const std::vector<FrameMotion>& measured) {
  motion_.predict(stamp_s, measured);
}

int TrackingSession::pointsInRange(const RgbdFrame& frame) const {
  return cv::countNonZero(depthInRange(frame, parameters_.depthRange()));
}

TrackingResult TrackingSession::track(const RgbdFrame& frame, const MotionPrior& prior,
                                      const FrameFeatures& features, const ModelView& view,
                                      StageTimers& timers) {
  TrackingResult result;
  if (motion_.isTracking()) {
    result = isFarFrom(view.T_W_D, prior)
                 ? tracker_.track(*depth_, render_(prior.T_W_D), prior, {prior}, timers)
                 : tracker_.track(*depth_, view, prior, motion_.otherStarts(), timers);
    const bool is_misled = result.status == TrackingStatus::kLost || !result.dropped_prior.empty();
    if (is_misled && prior.covariance && bendsFrames(parameters_.preprocessing))
      result = trackUnbent(frame, prior, result, view, timers);
  }
  return result.status == TrackingStatus::kLost ? relocalise(prior, features, result, timers) : result;
}

TrackingResult TrackingSession::trackUnbent(const RgbdFrame& frame, const MotionPrior& prior,
                                            const TrackingResult& bent, const ModelView& view,
                                            StageTimers& timers) {
  const std::shared_ptr<const DepthFrame> bent_depth = depth_;
  const std::vector<MotionPrior> starts = motion_.otherStarts();
  preprocessor_.process(frame, motion_.knownVelocity(), timers);
  depth_ = preprocessor_.result();
  TrackingResult result = tracker_.track(*depth_, view, starts.back(), starts, timers);
  if (result.status == TrackingStatus::kLost) {
    depth_ = bent_depth;
    return bent;
  }
  result.dropped_prior = prior.origin;
  result.prior_sigmas = bent.prior_sigmas;
  return result;
}

}  // namespace depth_fusion
