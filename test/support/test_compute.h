// The device that the tests of kernels run on.
#pragma once

#include <cstdlib>

#include "depth_fusion/compute/compute_context.h"

namespace depth_fusion {

// The environment variable DEPTH_FUSION_TEST_SIMD_WIDTH (1, 8 or 16) sets the kernels' width: 1 tests on a
// CPU the shape that they have on a GPU. 0 = the device's.
inline int testSimdWidth() {
  const char* width = std::getenv("DEPTH_FUSION_TEST_SIMD_WIDTH");
  return width == nullptr ? 0 : std::atoi(width);
}

// One a program.
inline ComputeContext& compute() {
  static ComputeContext context("", testSimdWidth());
  return context;
}

}  // namespace depth_fusion
