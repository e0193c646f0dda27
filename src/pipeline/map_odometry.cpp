#include "depth_fusion/pipeline/map_odometry.h"

namespace depth_fusion {
namespace {

constexpr double kMaxGap_s = 1.0;       // over which a mean velocity is one
constexpr double kUnmeasured_m = 0.33;  // standard deviation of a motion that nothing has measured
constexpr double kUnknown_rad = 0.33;

Matrix6d unknownMotion() {
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(kUnknown_rad * kUnknown_rad),
      Eigen::Vector3d::Constant(kUnmeasured_m * kUnmeasured_m);
  return variances.asDiagonal();
}

Matrix6d transformed(const Matrix6d& covariance, const Pose& T_A_B) {
  const Matrix6d to_A = adjoint(T_A_B);
  return to_A * covariance * to_A.transpose();
}

// The twist, in the later body's frame, of a body that goes steadily from the one to the other; the
// translation is that of half the way round.
Vector6d steadyTwist(const Pose& T_before_now) {
  Vector6d twist = twistFromPose(T_before_now);
  const Eigen::Vector3d rotation = twist.head<3>();
  const double angle_rad = rotation.norm();
  if (angle_rad > 0.0)
    twist.tail<3>() = Eigen::AngleAxisd(-0.5 * angle_rad, rotation / angle_rad) * twist.tail<3>();
  return twist;
}

}  // namespace

std::optional<OdometryState> MapOdometry::add(double stamp_s, const TrackingResult& tracked,
                                              const Pose& T_B_D) {
  const std::optional<Frame> before = last_;
  last_ = Frame{{stamp_s, tracked.T_W_D}, T_B_D, tracked.covariance};
  const bool begins_world = !before || is_elsewhere_;
  if (is_elsewhere_) covariance_ += transformed(unknownMotion(), T_O_B_);
  if (begins_world) place(tracked.T_W_D);
  is_elsewhere_ = false;

  const Pose T_W_B = tracked.T_W_D * T_B_D.inverse();
  T_O_B_ = orthonormalized(T_W_O_.inverse() * T_W_B);
  covariance_ = before_ + transformed(tracked.covariance + tracked.drift, T_W_O_.inverse());
  const double seconds = begins_world ? 0.0 : stamp_s - before->pose.stamp_s;
  if (!(seconds > 0.0 && seconds < kMaxGap_s)) return std::nullopt;
  const Pose T_before_now = T_B_D * before->pose.T_W_D.inverse() * T_W_B;
  const Matrix6d of_motion = transformed(before->covariance + tracked.covariance, T_W_B.inverse());
  return OdometryState{T_O_B_, covariance_, steadyTwist(T_before_now) / seconds,
                       of_motion / (seconds * seconds)};
}

void MapOdometry::place(const Pose& T_W_D) {
  last_->pose.T_W_D = T_W_D;
  T_W_O_ = orthonormalized(T_W_D * last_->T_B_D.inverse() * T_O_B_.inverse());
  before_ = covariance_;
}

}  // namespace depth_fusion
