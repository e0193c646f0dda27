// How colour is fused. The rows of table() say what each member means, in which unit and range.
#pragma once

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct ColorFusionParameters {
  float weight_at_1m = 16.0f;
  float max_weight = 64.0f;
  float max_relative_step = 0.03f;
  float hidden_sigmas = 2.0f;
  bool match_exposure = true;
  bool align = true;
  int sample_stride_px = 4;
  float blur_exponent = 3.0f;

  ParameterTable table();
};

}  // namespace depth_fusion
