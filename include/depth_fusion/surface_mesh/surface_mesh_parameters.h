// How the surface is extracted.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct SurfaceMeshParameters {
  int min_certainty = 1;
  int max_batch_blocks = 3072;

  ParameterTable table();
};

}  // namespace depth_fusion
