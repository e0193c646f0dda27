// How frames are registered. The rows of table() say what each member means, in which unit and range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct RegistrationParameters {
  float depth_unit_m = 0.0f;
  float depth_scale = 1.0f;
  bool depth_to_color = false;
  float max_relative_step = 0.03f;

  ParameterTable table();
};

}  // namespace depth_fusion
