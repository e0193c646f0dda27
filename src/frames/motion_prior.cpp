#include "depth_fusion/frames/motion_prior.h"

namespace depth_fusion {

MotionPrior FrameMotion::priorFrom(const Pose& T_W_previous) const {
  const Matrix6d to_world = adjoint(T_W_previous);
  return {orthonormalized(T_W_previous * T_previous_current), to_world * covariance * to_world.transpose(),
          origin};
}

}  // namespace depth_fusion
