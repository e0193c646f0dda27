// How the map is rendered.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct ModelViewParameters {
  std::string renderer = "ray_casting";
  bool half_size = false;

  ParameterTable table();
};

}  // namespace depth_fusion
