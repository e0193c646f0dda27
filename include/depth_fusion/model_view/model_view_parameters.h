// How the map is rendered. The rows of table() say what each member means, in which unit and range.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

enum class Renderer { kRayCasting, kMarchingCubes };

// The names of `renderer`.
const Enumeration<Renderer>& renderers();

struct ModelViewParameters {
  std::string renderer = "ray_casting";
  bool half_size = false;

  ParameterTable table();
};

}  // namespace depth_fusion
