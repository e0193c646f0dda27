// Whether and how loops of a live map are closed.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct MapRefinerParameters {
  bool close_loops = true;

  ParameterTable table();
};

}  // namespace depth_fusion
