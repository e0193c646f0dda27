#include "depth_fusion/robot_motion/robot_motion.h"

#include <utility>

namespace depth_fusion {

void RobotMotion::setParameters(const RobotMotionParameters& parameters) {
  validate(RobotMotionParameters(parameters).table());
  parameters_ = parameters;
  watch_.reset();  // what it remembers was judged by the parameters before
}

void RobotMotion::add(const MotionReadings& readings) {
  if (readings.empty()) return;
  for (const OdometryReading& reading : readings.odometry) odometry_.add(reading);
  for (const ImuReading& reading : readings.imu) {
    gyroscope_.add(reading);
    gravity_.add(reading, gyroscope_.bias_rad_s());
  }
  if (readings.T_B_D) T_B_D_ = readings.T_B_D;
}

RobotKnowledge RobotMotion::knowledge(double stamp_s) {
  asked_before_s_ = std::exchange(asked_s_, stamp_s);

  RobotKnowledge known;
  odometry_motion_.reset();
  if (parameters_.use_odometry) {
    if (const auto motion = odometry_.motionTo(stamp_s, parameters_)) {
      odometry_motion_ = motion->T_previous_current;
      known.motions.push_back(*motion);
    }
  }
  if (parameters_.use_gyroscope) {
    if (const auto motion = gyroscope_.motionTo(stamp_s, parameters_)) known.motions.push_back(*motion);
  }
  if (parameters_.use_gravity) known.attitude.up_D = gravity_.up_D();
  known.attitude.up_sigma_rad = parameters_.gravity_sigma_rad;
  if (parameters_.planar && T_B_D_) known.attitude.T_D_B = T_B_D_->inverse();
  return known;
}

void RobotMotion::learn(double stamp_s, const Pose& T_W_D) {
  const std::optional<StampedPose> before = std::exchange(tracked_, StampedPose{stamp_s, T_W_D});
  if (!before || before->stamp_s != asked_before_s_ || stamp_s != asked_s_) return;
  const Pose by_camera = orthonormalized(before->T_W_D.inverse() * T_W_D);
  gyroscope_.learn(by_camera.linear(), parameters_);
  if (odometry_motion_)
    watch_.add({stamp_s, stamp_s - before->stamp_s, by_camera, *odometry_motion_}, parameters_);
}

std::string RobotMotion::problem() const {
  if (parameters_.planar && !T_B_D_)
    return "robot_motion/planar is not used: nothing says where the camera stands on the robot; publish "
           "base_link -> camera on tf";
  return watch_.problem();
}

}  // namespace depth_fusion
