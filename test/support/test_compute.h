// The device that the tests of kernels run on.
#pragma once

#include <cstdlib>

#include "depth_fusion/compute/compute_context.h"

namespace depth_fusion {

// One a program. The environment variable DEPTH_FUSION_TEST_SIMD_WIDTH (1, 8 or 16) sets the kernels' width:
// 1 tests on a CPU the shape that they have on a GPU.
inline ComputeContext& compute() {
  static const char* width = std::getenv("DEPTH_FUSION_TEST_SIMD_WIDTH");
  static ComputeContext context("", width == nullptr ? 0 : std::atoi(width));
  return context;
}

}  // namespace depth_fusion
