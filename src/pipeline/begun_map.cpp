// How the conductor of tracking begins: with a frame, in another map or in another part of one.
#include <cstdio>
#include <utility>

#include "depth_fusion/pipeline/tracking_session.h"

namespace depth_fusion {
namespace {

constexpr double kOfStart = 1e-10;  // variance of the frame by which the world is defined
constexpr int kFramesAtGiven = 10;  // in which the sensor is searched for at a pose that was given

std::vector<Pose> posesOf(const Keyframes& keyframes) {
  std::vector<Pose> poses;
  for (const KeyframePtr& keyframe : keyframes) poses.push_back(keyframe->T_W_D);
  return poses;
}

}  // namespace

TrackingResult TrackingSession::begin(const RgbdFrame& frame, const Pose& T_W_D) const {
  TrackingResult first;
  first.prior = begins_part_ ? kPartStart : kStart;
  const int points = pointsInRange(frame);
  if (points < parameters_.icp_tracking.min_inliers) {
    first.reason = "only " + std::to_string(points) + " points with depth in range to begin with";
  } else {
    first.status = TrackingStatus::kTracking;
    first.reason = begins_anew_for_;
    first.T_W_D = T_W_D;
    first.covariance = kOfStart * Matrix6d::Identity();
  }
  return first;
}

void TrackingSession::reset(const Pose& T_W_D, Keyframes keyframes) {
  lose();
  motion_.loseAt(T_W_D);
  given_.reset();
  forgetMap();
  drift_.reset(posesOf(keyframes));
  relocaliser_.reset(std::move(keyframes));
  begins_anew_for_.clear();
}

void TrackingSession::searchAt(const Pose& T_W_D) {
  lose();
  motion_.loseAt(T_W_D);
  guessed_ = {};
  loss_.reset();
  given_ = {T_W_D, kFramesAtGiven};
}

void TrackingSession::beginAnew() {
  begins_anew_for_ = young_map_.reason();
  relocaliser_.reset();
  forgetMap();
}

void TrackingSession::forgetMap() {
  drift_.reset();
  carried_.setZero();
  tracker_.reset();
  young_map_.forget();
  guessed_ = {};
  watch_.reset();
  older_.forget();
  is_level_.reset();
  floor_z_m_.reset();
  loss_.reset();
  apart_.clear();
  begins_part_ = false;
}

void TrackingSession::beginPart() {
  char reason[200];
  std::snprintf(reason, sizeof(reason), "another part of the map begins, for the sensor was lost for %.1f s",
                loss_ ? loss_->until_s - loss_->since_s : 0.0);
  const double since_s = loss_ ? loss_->until_s : 0.0;
  forgetMap();
  begins_anew_for_ = reason;
  begins_part_ = true;
  standsApart(since_s);
}

void TrackingSession::standsApart(double since_s) {
  char doubt[200];
  std::snprintf(doubt, sizeof(doubt),
                "what is mapped since %.3f s stands where the sensor was expected after it was lost, until a "
                "loop joins it with the rest of the map",
                since_s);
  apart_ = doubt;
}

}  // namespace depth_fusion
