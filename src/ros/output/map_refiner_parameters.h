// Whether and how loops of a live map are closed.
#pragma once

#include "depth_fusion/loops/loop_parameters.h"

namespace depth_fusion {

struct MapRefinerParameters {
  bool close_loops = true;
  LoopParameters loops;  // the rows of a stage of its own

  ParameterTable table();
};

}  // namespace depth_fusion
