// What the conductor of tracking makes of what is known beside depth: gravity, a flat floor, other motions.
#include <Eigen/Cholesky>
#include <cmath>

#include "depth_fusion/pipeline/tracking_session.h"

namespace depth_fusion {

void TrackingSession::takeAttitude(const KnownAttitude& attitude) {
  KnownAttitude known = attitude;
  if (!is_level_.value_or(false)) known.up_D.reset();
  if (!floor_z_m_) known.T_D_B.reset();
  known.base_height_m = floor_z_m_.value_or(0.0);
  tracker_.setAttitude(known);
}

void TrackingSession::learnLevel(const KnownAttitude& attitude, const Pose& T_W_D) {
  if (!is_level_ && attitude.up_D) is_level_ = attitude.agreesAt(T_W_D);
  if (floor_z_m_ || !attitude.T_D_B) return;
  const Pose T_W_B = T_W_D * *attitude.T_D_B;
  const KnownAttitude base{Eigen::Vector3d::UnitZ()};
  if (base.agreesAt(T_W_B)) floor_z_m_ = T_W_B.translation().z();
}

void TrackingSession::comparePriors(TrackingResult& result) const {
  for (const MotionPrior& prior : motion_.measured()) {
    result.priors.push_back({prior.origin});
    if (result.status == TrackingStatus::kLost || !motion_.isTracking()) continue;
    const Vector6d difference = twistFromPose(orthonormalized(result.T_W_D * prior.T_W_D.inverse()));
    const Matrix6d covariance = *prior.covariance + result.covariance;
    result.priors.back().sigmas = std::sqrt(difference.dot(covariance.ldlt().solve(difference)) / 6.0);
  }
}

}  // namespace depth_fusion
