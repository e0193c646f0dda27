// What a bag says of the robot under its camera: odometry on tf, inertial sensors, the base.
#pragma once

#include <tf2/buffer_core.h>

#include <string>
#include <vector>

#include "depth_fusion/frames/motion_readings.h"
#include "ros/bags/bag_file.h"

namespace depth_fusion {

class BagRobot {
 public:
  // Reads tf, and of the inertial topics those that tf connects to the camera. A bag that has neither costs
  // nothing.
  BagRobot(const BagFiles& bags, const std::string& camera_frame);

  // The readings since the call before, and what odometry says of the very time.
  MotionReadings until(double stamp_s);
  // "odometry odom -> base_link, inertial sensor /imu/data"; empty if there is none.
  const std::string& description() const { return description_; }

 private:
  void findTree();
  void readImu(const BagFiles& bags, const std::string& topic);

  std::string camera_frame_;
  tf2::BufferCore tf_;
  std::string odometry_frame_;  // empty: there is none
  std::optional<Pose> T_B_D_;
  std::vector<ImuReading> imu_;  // all of them, in the order of their stamps
  size_t next_imu_ = 0;
  std::string description_;
};

}  // namespace depth_fusion
