#include "depth_fusion/pipeline/motion_model.h"

#include <algorithm>
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

// The camera alone does not go on where the map contradicts it: what misleads its depth misleads its texture.
constexpr char kTexture[] = "texture";

// A position with a larger standard deviation is not known.
constexpr double kUnknown_m = 1.0;

}  // namespace

MotionPrior MotionModel::predict(double stamp_s, const std::vector<FrameMotion>& measured) {
  const double since_last_s = stamp_s - std::exchange(stamp_s_, stamp_s);
  if (!tracked_) velocity_.setZero();
  measured_.clear();
  contradicting_.clear();
  if (measured.empty()) {
    if (!tracked_) covariance_.reset();
    return {T_W_expected_, std::nullopt, "last pose"};
  }
  FrameMotion motion = measured.front();
  for (const FrameMotion& one : measured) {
    measured_.push_back(one.priorFrom(T_W_expected_));
    if (&one == &measured.front()) continue;
    const std::optional<FrameMotion> both = combined(motion, one);
    if (!both) contradicting_.push_back(measured_.back());
    motion = both.value_or(motion);
  }
  MotionPrior prior = motion.priorFrom(T_W_expected_);
  velocity_ = velocityOver(motion.T_previous_current, since_last_s);
  T_W_expected_ = prior.T_W_D;
  if (covariance_) *covariance_ += *prior.covariance;
  const bool by_robot = std::any_of(measured.begin(), measured.end(),
                                    [](const FrameMotion& one) { return one.origin != kTexture; });
  if (covariance_ && by_robot) prior.covariance = covariance_;
  return prior;
}

std::optional<MotionPrior> MotionModel::bridged() const {
  if (!covariance_ || measured_.empty() || isTracking()) return std::nullopt;
  const Matrix6d to_sensor = adjoint(T_W_expected_.inverse());
  const Matrix6d covariance = to_sensor * *covariance_ * to_sensor.transpose();
  if (covariance.diagonal().tail<3>().maxCoeff() > kUnknown_m * kUnknown_m) return std::nullopt;
  std::string origins;
  for (const MotionPrior& prior : measured_) {
    const auto is_it = [&](const MotionPrior& other) { return other.origin == prior.origin; };
    if (std::any_of(contradicting_.begin(), contradicting_.end(), is_it)) continue;
    origins += (origins.empty() ? "" : ", ") + prior.origin;
  }
  if (origins.empty() || origins == kTexture) return std::nullopt;
  return MotionPrior{T_W_expected_, covariance_, origins};
}

const Vector6d& MotionModel::moveTo(double stamp_s, const Pose& T_W_D) {
  velocity_.setZero();
  if (tracked_) velocity_ = velocityOver(tracked_->T_W_D.inverse() * T_W_D, stamp_s - tracked_->stamp_s);
  tracked_ = last_known_ = {stamp_s, T_W_D};
  known_velocity_ = velocity_;
  T_W_expected_ = T_W_D;
  covariance_ = Matrix6d::Zero();
  return velocity_;
}

std::vector<MotionPrior> MotionModel::otherStarts() const {
  if (!last_known_) return {};
  std::vector<MotionPrior> starts = contradicting_;
  starts.push_back({last_known_->T_W_D, std::nullopt, "last pose"});
  if (isTracking() && !known_velocity_.isZero()) {
    const Pose motion = poseFromTwist(known_velocity_ * (stamp_s_ - last_known_->stamp_s));
    starts.push_back({orthonormalized(last_known_->T_W_D * motion), std::nullopt, "constant velocity"});
  }
  return starts;
}

void MotionModel::loseAt(const Pose& T_W_D) {
  lose();
  last_known_.reset();
  covariance_.reset();
  T_W_expected_ = T_W_D;
}

}  // namespace depth_fusion
