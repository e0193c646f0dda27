#include "depth_fusion/frames/known_attitude.h"

#include <cmath>

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr double kMostTilt_rad = 0.06;  // between gravity and z, in a world that is level
// How well a floor holds a robot: tighter than depth measures, so that it is all that counts.
constexpr double kFloor_rad = 2e-5, kFloor_m = 2e-5;

// The rotation that turns one direction into the other about the point p_W.
Pose turned(const Vector3d& from_W, const Vector3d& to_W, const Vector3d& p_W) {
  Pose turn = Pose::Identity();
  turn.linear() = Eigen::Quaterniond::FromTwoVectors(from_W, to_W).toRotationMatrix();
  turn.translation() = p_W - turn.linear() * p_W;
  return turn;
}

// A rotation x turns a direction v by x x v.
PoseMeasurement gravityAt(const Pose& T_W_D, const Vector3d& up_D, double sigma_rad) {
  PoseMeasurement measurement;
  measurement.information.diagonal().head<2>().setConstant(1.0 / (sigma_rad * sigma_rad));
  measurement.error.head<2>() = -(T_W_D.linear() * up_D).cross(Vector3d::UnitZ()).head<2>();
  return measurement;
}

PoseMeasurement floorAt(const Vector3d& p_W) {
  Vector6d height = Vector6d::Zero();
  height << p_W.y(), -p_W.x(), 0.0, 0.0, 0.0, 1.0;
  PoseMeasurement measurement;
  measurement.information = height * height.transpose() / (kFloor_m * kFloor_m);
  measurement.information.diagonal().head<2>().array() += 1.0 / (kFloor_rad * kFloor_rad);
  return measurement;
}

}  // namespace

void KnownAttitude::addTo(MotionPrior& prior) const {
  if (T_D_B) {
    const Pose T_W_B = prior.T_W_D * *T_D_B;
    const Vector3d p_W = T_W_B.translation();
    prior.T_W_D = turned(T_W_B.linear().col(2), Vector3d::UnitZ(), p_W) * prior.T_W_D;
    prior.T_W_D.translation().z() += base_height_m - p_W.z();
    prior.measured_pose = floorAt({p_W.x(), p_W.y(), base_height_m});
  } else if (up_D) {
    prior.measured_pose = gravityAt(prior.T_W_D, *up_D, up_sigma_rad);
  }
}

bool KnownAttitude::agreesAt(const Pose& T_W_D) const {
  return up_D && (T_W_D.linear() * *up_D).z() > std::cos(kMostTilt_rad);
}

Pose startPose(const KnownAttitude& attitude) {
  if (attitude.T_D_B) return attitude.T_D_B->inverse();
  return attitude.up_D ? levelPose(*attitude.up_D) : Pose::Identity();
}

Pose levelPose(const Vector3d& up_D) {
  // The camera's axis, or where it looks straight up or down the top of its image, is ahead.
  const Vector3d axis = std::abs(up_D.z()) < 0.99 ? Vector3d::UnitZ() : Vector3d(0.0, up_D.z(), 0.0);
  const Vector3d ahead_D = (axis - axis.dot(up_D) * up_D).normalized();
  Pose T_W_D = Pose::Identity();
  T_W_D.linear() << ahead_D.transpose(), up_D.cross(ahead_D).transpose(), up_D.transpose();
  return T_W_D;
}

}  // namespace depth_fusion
