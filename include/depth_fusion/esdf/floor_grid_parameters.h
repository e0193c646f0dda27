// How space becomes a flat grid for robots that drive. The rows of table() say what each member means, in
// which unit and range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct FloorGridParameters {
  float min_height_m = 0.1f;
  float max_height_m = 1.8f;
  bool find_ground = true;
  float ground_z_m = 0.0f;
  float max_step_m = 0.1f;

  ParameterTable table();
};

}  // namespace depth_fusion
