// What sensors beside the camera say of the robot's motion.
#pragma once

#include <optional>
#include <vector>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// An inertial sensor's, turned into the axes of the depth camera.
struct ImuReading {
  double stamp_s = 0.0;
  std::optional<Eigen::Vector3d> angular_velocity_D;  // rad/s
  std::optional<Eigen::Vector3d> specific_force_D;    // m/s^2: of a sensor at rest 9.81 upwards
};

// Where odometry says that the depth camera is, in a frame O that drifts.
struct OdometryReading {
  double stamp_s = 0.0;
  Pose T_O_D = Pose::Identity();
};

// What was read since the frame before, in the order of the stamps.
struct MotionReadings {
  std::vector<ImuReading> imu;
  std::vector<OdometryReading> odometry;
  std::optional<Pose> T_B_D;  // the camera on the robot's base B: x forward, z up, origin on the ground

  bool empty() const { return imu.empty() && odometry.empty() && !T_B_D; }
};

}  // namespace depth_fusion
