// benchmark suite: what the device can do at most.
#pragma once

#include "depth_fusion/compute/compute_context.h"

namespace depth_fusion {

// Registers limit/*: the launch of an empty kernel, copying memory, multiply-adds, gathers from tables of
// several sizes.
void registerLimitBenchmarks(ComputeContext& compute);

}  // namespace depth_fusion
