#include "ros/output/pose_parameters.h"

namespace depth_fusion {

ParameterTable PoseParameters::table() {
  return atStartOnly(
      {flag("publish_tf", &publish_tf, "false: poses as messages only"),
       text("map_frame", &map_frame, "frame of the map and of the poses"),
       text("odom_frame", &odom_frame,
            "child of map_frame on tf, where the robot has odometry; empty: base_frame, or the root of the "
            "camera's tree"),
       text("base_frame", &base_frame, "child of map_frame on tf, where the robot has no odometry"),
       text("visual_odom_frame", &visual_odom_frame,
            "child of map_frame on tf: frame of icp_tracking/odometry, where the robot's base was at the "
            "start; it moves where closed loops move the map"),
       text("view_frame", &view_frame,
            "a frame on tf that follows the camera and stays level, for the view of rviz; empty: none"),
       flag("level_start", &level_start,
            "true: a camera without a tf tree starts looking along x with z up; false: the map is the first "
            "optical frame"),
       number("transform_tolerance", &transform_tolerance_s, 0.0, 10.0,
              "how far ahead map_frame -> odometry is stamped, in seconds, so that who looks it up need not "
              "wait for the next one")});
}

}  // namespace depth_fusion
