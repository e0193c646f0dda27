// The rules of fusion and the kinds of distance, by name: the parameters' choices and the kernels' build
// options both come from here.
#pragma once

#include <string>

#include "depth_fusion/tsdf_fusion/tsdf_fusion_parameters.h"

namespace depth_fusion {

std::vector<std::string> fusionDistances();

// Build options of integrate_blocks. Throws Error for a rule or a distance that there is not.
std::string filterOptions(const TsdfFusionParameters& parameters);

}  // namespace depth_fusion
