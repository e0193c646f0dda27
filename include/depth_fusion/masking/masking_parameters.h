// What of depth images is not the world's. The rows of table() say what each member means.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct MaskingParameters {
  std::string body;
  std::string robot_description;
  float padding_m = 0.03f;
  float max_wait_s = 0.3f;

  ParameterTable table();
};

}  // namespace depth_fusion
