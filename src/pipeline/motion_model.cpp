#include "depth_fusion/pipeline/motion_model.h"

#include <utility>

namespace depth_fusion {
namespace {

// The velocity over a motion that took `seconds`; zero over a longer gap, which does not say how fast the
// sensor is now.
Vector6d velocityOver(const Pose& T_before_now, double seconds) {
  constexpr double kMaxGap_s = 0.25;
  if (!(seconds > 0.0 && seconds < kMaxGap_s)) return Vector6d::Zero();
  return twistFromPose(T_before_now) / seconds;
}

}  // namespace

MotionPrior MotionModel::predict(double stamp_s, const std::vector<FrameMotion>& measured) {
  const double since_last_s = stamp_s - std::exchange(stamp_s_, stamp_s);
  if (!tracked_) velocity_.setZero();
  if (measured.empty()) return {T_W_expected_, std::nullopt, "last pose"};
  MotionPrior prior = measured.front().priorFrom(T_W_expected_);
  velocity_ = velocityOver(measured.front().T_previous_current, since_last_s);
  T_W_expected_ = prior.T_W_D;
  return prior;
}

const Vector6d& MotionModel::moveTo(double stamp_s, const Pose& T_W_D) {
  velocity_.setZero();
  if (tracked_) velocity_ = velocityOver(tracked_->T_W_D.inverse() * T_W_D, stamp_s - tracked_->stamp_s);
  tracked_ = last_known_ = {stamp_s, T_W_D};
  known_velocity_ = velocity_;
  T_W_expected_ = T_W_D;
  return velocity_;
}

std::vector<MotionPrior> MotionModel::otherStarts() const {
  if (!last_known_) return {};
  std::vector<MotionPrior> starts = {{last_known_->T_W_D, std::nullopt, "last pose"}};
  if (isTracking() && !known_velocity_.isZero()) {
    const Pose motion = poseFromTwist(known_velocity_ * (stamp_s_ - last_known_->stamp_s));
    starts.push_back({orthonormalized(last_known_->T_W_D * motion), std::nullopt, "constant velocity"});
  }
  return starts;
}

void MotionModel::loseAt(const Pose& T_W_D) {
  lose();
  last_known_.reset();
  T_W_expected_ = T_W_D;
}

}  // namespace depth_fusion
