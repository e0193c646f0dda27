// How depth is fused.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct TsdfFusionParameters {
  std::string rule = "kalman";
  std::string distance = "plane";
  float gain_at_1m = 0.02f;
  float weight_at_1m = 4.0f;
  float max_weight = 255.0f;
  float process_sigma_m = 3e-5f;
  float free_space_sigmas = 2.0f;
  float free_space_rate = 0.4f;

  ParameterTable table();
};

// The values that TsdfFusionParameters::rule takes.
std::vector<std::string> fusionRules();

}  // namespace depth_fusion
