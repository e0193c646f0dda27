// How the map is made. The rows of table() say what each member means, in which unit and range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct MapParameters {
  float voxel_size_m = 0.005f;
  int blocks_per_axis = 256;
  int block_size = 8;
  float truncation_m = 0.0f;
  int pool_mib = 512;
  bool color = false;

  ParameterTable table();
};

}  // namespace depth_fusion
