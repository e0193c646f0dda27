// How the surface is extracted. The rows of table() say what each member means, in which unit and range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct SurfaceMeshParameters {
  int min_certainty = 1;
  int max_batch_blocks = 3072;

  ParameterTable table();
};

}  // namespace depth_fusion
