// Where the tracker's poses go.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct PoseParameters {
  bool publish_tf = true;
  std::string map_frame = "map";
  std::string odom_frame;
  std::string base_frame;
  bool level_start = true;

  ParameterTable table();
};

}  // namespace depth_fusion
