// The rules of fusion and the kinds of distance, by name: the parameters' choices and the kernels' build
// options both come from here.
#pragma once

#include <string>

#include "depth_fusion/common/enumeration.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion_parameters.h"

namespace depth_fusion {

// The values are those of the kernels' macros FUSION_RULE and FUSION_DISTANCE.
const Enumeration<int>& filterRules();
const Enumeration<int>& filterDistances();

// Build options of integrate_blocks. Throws Error for a rule or a distance that there is not.
std::string filterOptions(const TsdfFusionParameters& parameters);

}  // namespace depth_fusion
