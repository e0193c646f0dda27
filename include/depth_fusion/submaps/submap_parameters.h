// Where what a sensor has left behind is kept. The rows of table() say what each member means, in which unit
// and range.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct SubmapParameters {
  int memory_mib = 64;
  int disk_mib = 16384;
  std::string store;
  float drift = 0.005f;
  float sure_m = 0.05f;
  float max_length_m = 0.0f;

  ParameterTable table();
};

}  // namespace depth_fusion
