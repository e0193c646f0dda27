// How the map is pictured for viewers.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct ModelPictureParameters {
  std::string picture = "shaded";
  float picture_rate_hz = 5.0f;

  ParameterTable table();
};

}  // namespace depth_fusion
