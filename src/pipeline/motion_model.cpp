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
  tracked_ = {stamp_s, T_W_D};
  T_W_expected_ = T_W_D;
  return velocity_;
}

void MotionModel::loseAt(const Pose& T_W_D) {
  lose();
  T_W_expected_ = T_W_D;
}

}  // namespace depth_fusion
