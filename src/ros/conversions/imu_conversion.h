// Inertial sensors' messages.
#pragma once

#include <sensor_msgs/Imu.h>

#include "depth_fusion/frames/motion_readings.h"

namespace depth_fusion {

// What the message measures: not what its covariance says is not there (-1), nor a force of exactly zero,
// which drivers of a gyroscope alone send. R_D_I turns the sensor's axes into those of the depth camera.
ImuReading toReading(const sensor_msgs::Imu& message, const Eigen::Matrix3d& R_D_I);

// `R_I_D` turns the axes of the depth camera into those of the sensor.
sensor_msgs::Imu makeImu(const std_msgs::Header& header, const ImuReading& reading,
                         const Eigen::Matrix3d& R_I_D);

}  // namespace depth_fusion
