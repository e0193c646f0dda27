// How the sensor moves from frame to frame: where the next frame is expected, and how fast the sensor is.
#pragma once

#include <optional>
#include <vector>

#include "depth_fusion/frames/motion_prior.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// The state is a value: a copy remembers it.
class MotionModel {
 public:
  // Goes on to the frame at stamp_s and returns its prior: by the first of the motions measured since the
  // frame before, with those that agree with it, or the last pose if nothing was measured. While the sensor
  // is lost, and something else than texture measures its motion, its covariance grows from frame to frame.
  MotionPrior predict(double stamp_s, const std::vector<FrameMotion>& measured);
  // The frame at stamp_s is known to be at T_W_D. Returns the velocity from the frame before to there.
  const Vector6d& moveTo(double stamp_s, const Pose& T_W_D);
  // Where else the sensor may be at the frame predicted last: by the motions that contradict the first one,
  // at its last known pose, and where it gets by the velocity that it had before that. Empty if no pose was
  // ever known.
  std::vector<MotionPrior> otherStarts() const;
  // Where each of the motions puts the frame predicted last.
  const std::vector<MotionPrior>& measured() const { return measured_; }
  // Where a lost sensor is, if all of its motion since its last known pose was measured, and the last of it
  // not by texture alone.
  std::optional<MotionPrior> bridged() const;
  // The pose of the frame is not known; the sensor is expected where the frame's prior was.
  void lose() { tracked_.reset(); }
  // The pose of the frame is not known; the sensor is expected at T_W_D.
  void loseAt(const Pose& T_W_D);

  // Whether the pose of the frame before is known.
  bool isTracking() const { return tracked_.has_value(); }
  // The sensor's velocity in its own frame D: rotation (rad/s), translation (m/s). Zero where nothing says
  // how fast the sensor is.
  const Vector6d& velocity() const { return velocity_; }
  // The velocity that the last known pose was reached by.
  const Vector6d& knownVelocity() const { return known_velocity_; }

 private:
  std::optional<StampedPose> tracked_;    // the frame before; none if that is lost
  Pose T_W_expected_ = Pose::Identity();  // the last known pose, moved on by the motions measured since
  // This is the covariance of T_W_expected_; none if a motion since the last known pose was not measured.
  std::optional<Matrix6d> covariance_;
  std::vector<MotionPrior> measured_, contradicting_;
  double stamp_s_ = 0.0;  // of the frame predicted last
  Vector6d velocity_ = Vector6d::Zero();
  std::optional<StampedPose> last_known_;       // as tracked_, and kept through losses
  Vector6d known_velocity_ = Vector6d::Zero();  // in D, at last_known_
};

}  // namespace depth_fusion
