// Where a live map is kept.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct MapKeeperParameters {
  std::string map_file;  // empty: nowhere
  float save_period_s = 0.0f;
  bool read_only = false;

  ParameterTable table();
};

}  // namespace depth_fusion
