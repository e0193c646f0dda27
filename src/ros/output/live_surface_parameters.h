// How much of a map's surface viewers are shown at a time.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct LiveSurfaceParameters {
  int chunk_blocks = 16;
  int chunks_per_update = 8;
  int refresh_chunks = 0;
  float triangle_share = 0.3f;
  float max_bandwidth_mb_s = 5.0f;
  float point_spacing_m = 0.02f;

  ParameterTable table();
};

}  // namespace depth_fusion
