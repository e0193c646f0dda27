#include "depth_fusion/frames/motion_prior.h"

#include <Eigen/LU>

namespace depth_fusion {
namespace {

// Of two motions' squared distance in standard deviations: one of 20,000 pairs that say the same is farther.
constexpr double kContradiction = 30.0;

}  // namespace

MotionPrior FrameMotion::priorFrom(const Pose& T_W_previous) const {
  const Matrix6d to_world = adjoint(T_W_previous);
  return {orthonormalized(T_W_previous * T_previous_current), to_world * covariance * to_world.transpose(),
          origin};
}

std::optional<FrameMotion> combined(const FrameMotion& a, const FrameMotion& b) {
  const Vector6d difference = twistFromPose(b.T_previous_current * a.T_previous_current.inverse());
  const Matrix6d weights = Matrix6d(a.covariance + b.covariance).inverse();
  if (difference.dot(weights * difference) > kContradiction) return std::nullopt;
  const Matrix6d gain = a.covariance * weights;
  return FrameMotion{a.origin + ", " + b.origin,
                     orthonormalized(poseFromTwist(gain * difference) * a.T_previous_current),
                     gain * b.covariance};
}

}  // namespace depth_fusion
