// The device that the tests of kernels run on.
#pragma once

#include <cstdlib>

#include "depth_fusion/compute/compute_context.h"

namespace depth_fusion {

// Returns 0 if the environment variable is not set.
inline int numberFromEnvironment(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::atoi(text);
}

// The environment variables DEPTH_FUSION_TEST_SIMD_WIDTH (1, 8 or 16) and DEPTH_FUSION_TEST_GROUP_SIZE set
// the kernels' shape: a width of 1 tests on a CPU the shape that they have on a GPU. 0 stands for the
// device's own.
inline int testSimdWidth() { return numberFromEnvironment("DEPTH_FUSION_TEST_SIMD_WIDTH"); }
inline int testGroupSize() { return numberFromEnvironment("DEPTH_FUSION_TEST_GROUP_SIZE"); }

// A program has one context.
inline ComputeContext& compute() {
  static ComputeContext context("", testSimdWidth(), testGroupSize());
  return context;
}

}  // namespace depth_fusion
