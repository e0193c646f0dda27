// Rigid motions. T_A_B maps a point of frame B into frame A: p_A = T_A_B * p_B. Metres and radians.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace depth_fusion {

using Pose = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct StampedPose {
  double stamp_s = 0.0;
  Pose T_W_D = Pose::Identity();
};

using Trajectory = std::vector<StampedPose>;

// The motion of rotation vector twist[0..2] (rad) about the origin, followed by translation twist[3..5] (m).
inline Pose poseFromTwist(const Vector6d& twist) {
  const Eigen::Vector3d rotation = twist.head<3>();
  const double angle_rad = rotation.norm();
  Pose motion = Pose::Identity();
  if (angle_rad > 0.0)
    motion.linear() = Eigen::AngleAxisd(angle_rad, rotation / angle_rad).toRotationMatrix();
  motion.translation() = twist.tail<3>();
  return motion;
}

// The pose with its rotation made orthonormal. Isometry3d inverts by transposing, so that products of poses
// and inverses of poses triple a rotation's rounding error each time: whoever chains poses must stop that.
inline Pose orthonormalized(const Pose& pose) {
  Pose result = pose;
  result.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return result;
}

// The twist that poseFromTwist makes this motion of.
inline Vector6d twistFromPose(const Pose& motion) {
  const Eigen::AngleAxisd rotation(motion.linear());
  Vector6d twist;
  twist << rotation.angle() * rotation.axis(), motion.translation();
  return twist;
}

// The matrix that takes x to v x x.
inline Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d cross;
  cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return cross;
}

// Small twists in frame B, as seen from A: exp(adjoint(T_A_B) x) T_A_B = T_A_B exp(x), to first order.
inline Matrix6d adjoint(const Pose& T_A_B) {
  Matrix6d result = Matrix6d::Zero();
  result.topLeftCorner<3, 3>() = result.bottomRightCorner<3, 3>() = T_A_B.linear();
  result.bottomLeftCorner<3, 3>() = crossMatrix(T_A_B.translation()) * T_A_B.linear();
  return result;
}

inline double rotationAngle(const Pose& motion) { return Eigen::AngleAxisd(motion.linear()).angle(); }

// The pose at stamp_s on the straight (slerp) way between two poses; extrapolates outside of them.
inline Pose interpolate(const StampedPose& a, const StampedPose& b, double stamp_s) {
  const double fraction = (stamp_s - a.stamp_s) / (b.stamp_s - a.stamp_s);
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(a.T_W_D.linear())
                      .slerp(fraction, Eigen::Quaterniond(b.T_W_D.linear()))
                      .toRotationMatrix();
  pose.translation() = (1.0 - fraction) * a.T_W_D.translation() + fraction * b.T_W_D.translation();
  return pose;
}

}  // namespace depth_fusion
