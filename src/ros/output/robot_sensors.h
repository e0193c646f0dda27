// The robot's own sensors beside the camera, as they are when a frame is tracked.
#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/Imu.h>

#include <deque>
#include <mutex>

#include "ros/output/transform_sender.h"

namespace depth_fusion {

class RobotSensors {
 public:
  // Subscribes `imu`. Keeps a reference to the transforms, which know the robot's tree and its odometry.
  RobotSensors(ros::NodeHandle handle, const TransformSender& transforms);

  // The readings that have come since the call before, by the clock of the images: a frame of the stamp
  // `stamp_s` has that of `camera` in ROS. From any thread.
  MotionReadings until(const std_msgs::Header& camera, double stamp_s);

 private:
  void receive(const sensor_msgs::Imu::ConstPtr& message);

  const TransformSender& transforms_;
  std::mutex mutex_;
  std::deque<sensor_msgs::Imu::ConstPtr> messages_;
  ros::Subscriber subscriber_;  // last: its callback uses the others
};

}  // namespace depth_fusion
