// The robot under a simulated camera: wheels whose odometry drifts and slips, and an inertial sensor.
#pragma once

#include <functional>
#include <random>

#include "depth_fusion/frames/motion_readings.h"

namespace depth_fusion {

struct RobotOptions {
  bool has_wheels = false, has_imu = false;
  double wheel_rate_hz = 50.0;
  double wheel_delay_s = 0.0;          // from a reading's stamp to when it is there
  double wheel_scale_error = 0.02;     // of distances
  double wheel_heading_rad_m = 0.005;  // by which the heading drifts
  double slip_m = 0.0, slip_s = 3.0;   // the wheels turn by so much more, in half a second from then on
  double imu_rate_hz = 200.0;
  double gyroscope_bias_rad_s = 0.01, gyroscope_noise_rad_s = 0.005;
  double accelerometer_noise_m_s2 = 0.1;
};

class SimulatedRobot {
 public:
  // T_W_D at a time, in a world whose z is up. Readings have stamps later by first_stamp_s.
  using Path = std::function<Pose(double time_s)>;
  SimulatedRobot(const RobotOptions& options, Path path, const Pose& T_B_D, double first_stamp_s,
                 unsigned seed);

  // The readings that have come since the last call.
  MotionReadings until(double time_s);

 private:
  OdometryReading roll();  // the wheels on to their next reading
  ImuReading sense();
  Eigen::Vector3d noise(double sigma);

  RobotOptions options_;
  Path path_;
  Pose T_B_D_;
  double first_stamp_s_;
  std::mt19937_64 random_;
  Pose T_O_B_ = Pose::Identity();
  int wheel_readings_ = 0, imu_readings_ = 0;
};

}  // namespace depth_fusion
