#include "depth_fusion/robot_motion/wheel_odometry.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

constexpr double kKept_s = 2.0;     // that readings may be ahead of the frames
constexpr double kLongest_s = 0.5;  // that odometry is drawn on
constexpr double kFastest_m_s = 5.0, kFastest_rad_s = 10.0;
constexpr double kJump_m = 0.2, kJump_rad = 0.3;  // beyond that, with the fastest motion
// How a robot may speed up while nothing is heard of it.
constexpr double kSpeedUp_m_s2 = 0.5, kSpeedUp_rad_s2 = 1.0;
// What odometry is off by at the least in a frame, and its heading by the way.
constexpr double kLeast_m = 1e-3, kLeast_rad = 1e-3, kHeading_rad_m = 0.02;

bool isJump(const Pose& motion, double seconds) {
  return motion.translation().norm() > kJump_m + kFastest_m_s * seconds ||
         rotationAngle(motion) > kJump_rad + kFastest_rad_s * seconds;
}

Matrix6d covarianceOf(double way_m, double angle_rad, double drawn_on_s2,
                      const RobotMotionParameters& parameters) {
  const double m = kLeast_m + parameters.odometry_distance_sigma * way_m + kSpeedUp_m_s2 * drawn_on_s2;
  const double rad = kLeast_rad + parameters.odometry_angle_sigma * angle_rad + kHeading_rad_m * way_m +
                     kSpeedUp_rad_s2 * drawn_on_s2;
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(rad * rad), Eigen::Vector3d::Constant(m * m);
  return variances.asDiagonal();
}

}  // namespace

void WheelOdometry::add(const OdometryReading& reading) {
  Passed passed{reading, 0.0, 0.0};
  if (!passed_.empty()) {
    const Passed& last = passed_.back();
    const double seconds = reading.stamp_s - last.reading.stamp_s;
    if (seconds <= 0.0 && seconds > -kKept_s) return;
    const Pose motion = last.reading.T_O_D.inverse() * reading.T_O_D;
    if (seconds < 0.0 || isJump(motion, seconds)) {
      passed_.clear();
      before_.reset();
    } else {
      passed.way_m = last.way_m + motion.translation().norm();
      passed.angle_rad = last.angle_rad + rotationAngle(motion);
    }
  }
  passed_.push_back(passed);
  while (passed_.size() > 2 && passed_[1].reading.stamp_s < reading.stamp_s - kKept_s) passed_.pop_front();
}

std::optional<FrameMotion> WheelOdometry::motionTo(double stamp_s, const RobotMotionParameters& parameters) {
  const std::optional<Place> before = std::exchange(before_, at(stamp_s));
  if (!before || !before_) return std::nullopt;
  const double drawn_on_s2 = 0.5 * (std::pow(before->drawn_on_s, 2) + std::pow(before_->drawn_on_s, 2));
  return FrameMotion{"odometry", orthonormalized(before->T_O_D.inverse() * before_->T_O_D),
                     covarianceOf(std::abs(before_->way_m - before->way_m),
                                  std::abs(before_->angle_rad - before->angle_rad), drawn_on_s2, parameters)};
}

std::optional<WheelOdometry::Place> WheelOdometry::at(double stamp_s) const {
  if (passed_.empty() || stamp_s < passed_.front().reading.stamp_s) return std::nullopt;
  size_t next = 0;
  while (next < passed_.size() && passed_[next].reading.stamp_s < stamp_s) ++next;
  if (next < passed_.size() && passed_[next].reading.stamp_s == stamp_s)
    return Place{passed_[next].reading.T_O_D, 0.0, passed_[next].way_m, passed_[next].angle_rad};
  if (passed_.size() < 2) return std::nullopt;
  const Passed& from = passed_[std::min(next, passed_.size() - 1) - 1];
  const Passed& to = passed_[std::min(next, passed_.size() - 1)];
  const double drawn_on_s = std::max(stamp_s - passed_.back().reading.stamp_s, 0.0);
  if (drawn_on_s > kLongest_s) return std::nullopt;
  const double part = (stamp_s - from.reading.stamp_s) / (to.reading.stamp_s - from.reading.stamp_s);
  const Vector6d twist = twistFromPose(orthonormalized(from.reading.T_O_D.inverse() * to.reading.T_O_D));
  return Place{orthonormalized(from.reading.T_O_D * poseFromTwist(part * twist)), drawn_on_s,
               from.way_m + part * (to.way_m - from.way_m),
               from.angle_rad + part * (to.angle_rad - from.angle_rad)};
}

}  // namespace depth_fusion
