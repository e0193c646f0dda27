// How finely and how far distances are computed. The rows of table() say what each member means, in which
// unit and range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct EsdfParameters {
  float voxel_size_m = 0.05f;
  float max_distance_m = 2.0f;
  int frame_stride = 3;
  int memory_mib = 512;

  ParameterTable table();
};

}  // namespace depth_fusion
