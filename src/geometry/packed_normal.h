// Normals of pixels, packed in words as kernels/shared/types.h has it, on the host.
#pragma once

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

#include "shared/types.h"

namespace depth_fusion {

// 0 for the zero vector.
inline uint32_t packedNormal(const cv::Vec3f& n) {
  if (n == cv::Vec3f()) return 0;
  const auto code = [&](float component) {
    return static_cast<uint32_t>(std::lround(component / (1.0 - n[2]) * NORMAL_STEPS + NORMAL_ZERO));
  };
  return code(n[0]) | code(n[1]) << 16;
}

inline cv::Vec3f unpackedNormal(uint32_t word) {
  if (word == 0) return {};
  const auto coordinate = [](uint32_t code) {
    return (static_cast<float>(code) - NORMAL_ZERO) / NORMAL_STEPS;
  };
  const double u = coordinate(word & 0xffff), v = coordinate(word >> 16);
  return cv::Vec3d(2.0 * u, 2.0 * v, u * u + v * v - 1.0) / (1.0 + u * u + v * v);
}

}  // namespace depth_fusion
