// How the tracker's poses go out to the rest of the robot.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct PoseParameters {
  bool publish_tf = true;
  std::string map_frame = "map";
  std::string odom_frame;
  std::string base_frame;
  std::string visual_odom_frame = "visual_odom";
  std::string view_frame;  // empty: none
  bool level_start = true;
  float transform_tolerance_s = 0.1f;

  ParameterTable table();
  // The frame that is to be the child of map_frame on tf; empty: it is found.
  const std::string& givenRoot() const { return odom_frame.empty() ? base_frame : odom_frame; }
};

}  // namespace depth_fusion
