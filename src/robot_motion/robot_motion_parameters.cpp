#include "depth_fusion/robot_motion/robot_motion_parameters.h"

namespace depth_fusion {

ParameterTable RobotMotionParameters::table() {
  return {
      flag("use_odometry", &use_odometry, "true: the robot's odometry, where there is one, is a prior"),
      flag("use_gyroscope", &use_gyroscope, "true: a gyroscope's rotation, where there is one, is a prior"),
      flag("use_gravity", &use_gravity,
           "true: an accelerometer, where there is one, has the map begin level, and holds roll and pitch"),
      flag("planar", &planar,
           "true: the robot's base keeps upright and at one height, so that it moves in x, y and yaw"),
      number("odometry_distance_sigma", &odometry_distance_sigma, 1e-4, 1.0,
             "standard deviation of odometry's distances, as a part of the distance"),
      number("odometry_angle_sigma", &odometry_angle_sigma, 1e-4, 1.0,
             "standard deviation of odometry's angles, as a part of the angle"),
      expert({number("gyroscope_noise_rad_s", &gyroscope_noise_rad_s, 1e-5, 1.0,
                     "standard deviation of a gyroscope's rate, beside its bias")})
          .front(),
      expert({number("gravity_sigma_rad", &gravity_sigma_rad, 1e-4, 1.0,
                     "standard deviation of the direction of gravity")})
          .front()};
}

}  // namespace depth_fusion
