// What planners are given of a live map.
#pragma once

#include <string>

#include "depth_fusion/esdf/floor_grid_parameters.h"

namespace depth_fusion {

struct NavigationParameters {
  FloorGridParameters grid;
  float slice_z_m = 0.5f;
  std::string scan_frame;  // empty: there is no scan
  float scan_range_m = 5.0f;

  ParameterTable table();
};

}  // namespace depth_fusion
