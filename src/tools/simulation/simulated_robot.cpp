#include "tools/simulation/simulated_robot.h"

#include <utility>

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr double kGravity_m_s2 = 9.81;
constexpr double kSlipping_s = 0.5;
constexpr double kStep_s = 1e-3;  // of the derivatives

}  // namespace

SimulatedRobot::SimulatedRobot(const RobotOptions& options, Path path, const Pose& T_B_D,
                               double first_stamp_s, unsigned seed)
    : options_(options),
      path_(std::move(path)),
      T_B_D_(T_B_D),
      first_stamp_s_(first_stamp_s),
      random_(seed) {}

MotionReadings SimulatedRobot::until(double time_s) {
  MotionReadings readings;
  readings.T_B_D = T_B_D_;
  while (options_.has_wheels &&
         wheel_readings_ / options_.wheel_rate_hz + options_.wheel_delay_s <= time_s + 1e-9)
    readings.odometry.push_back(roll());
  while (options_.has_imu && imu_readings_ / options_.imu_rate_hz <= time_s + 1e-9)
    readings.imu.push_back(sense());
  return readings;
}

OdometryReading SimulatedRobot::roll() {
  const double now_s = wheel_readings_ / options_.wheel_rate_hz;
  if (wheel_readings_++ > 0) {
    const double before_s = now_s - 1.0 / options_.wheel_rate_hz;
    Vector6d twist =
        twistFromPose(orthonormalized(T_B_D_ * path_(before_s).inverse() * path_(now_s) * T_B_D_.inverse()));
    const double way_m = twist.tail<3>().norm();
    twist.tail<3>() *= 1.0 + options_.wheel_scale_error;
    twist[2] += options_.wheel_heading_rad_m * way_m;
    const bool slips = before_s >= options_.slip_s && before_s < options_.slip_s + kSlipping_s - 1e-9;
    if (slips) twist[3] += options_.slip_m / (kSlipping_s * options_.wheel_rate_hz);
    T_O_B_ = orthonormalized(T_O_B_ * poseFromTwist(twist));
  }
  return {first_stamp_s_ + now_s, T_O_B_ * T_B_D_};
}

ImuReading SimulatedRobot::sense() {
  const double now_s = imu_readings_++ / options_.imu_rate_hz;
  const Pose before = path_(now_s - kStep_s), now = path_(now_s), after = path_(now_s + kStep_s);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(before.linear().transpose() * after.linear()));
  const Vector3d acceleration_W =
      (before.translation() - 2.0 * now.translation() + after.translation()) / (kStep_s * kStep_s);
  ImuReading reading;
  reading.stamp_s = first_stamp_s_ + now_s;
  reading.angular_velocity_D = turn.angle() * turn.axis() / (2.0 * kStep_s) +
                               Vector3d::Constant(options_.gyroscope_bias_rad_s) +
                               noise(options_.gyroscope_noise_rad_s);
  reading.specific_force_D = now.linear().transpose() * (acceleration_W + kGravity_m_s2 * Vector3d::UnitZ()) +
                             noise(options_.accelerometer_noise_m_s2);
  return reading;
}

Vector3d SimulatedRobot::noise(double sigma) {
  std::normal_distribution<double> normal(0.0, sigma);
  Vector3d result;
  for (double& value : result) value = normal(random_);
  return result;
}

}  // namespace depth_fusion
