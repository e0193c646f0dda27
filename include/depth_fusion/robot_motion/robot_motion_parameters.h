// What is believed of the sensors beside the camera. The rows of table() say what each member means, in which
// unit and range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct RobotMotionParameters {
  bool use_odometry = true;
  bool use_gyroscope = true;
  bool use_gravity = true;
  bool planar = false;
  float odometry_distance_sigma = 0.05f;
  float odometry_angle_sigma = 0.05f;
  float gyroscope_noise_rad_s = 0.005f;
  float gravity_sigma_rad = 0.02f;

  ParameterTable table();
};

}  // namespace depth_fusion
