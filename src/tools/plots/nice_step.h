// The step of a plot's lines.
#pragma once

#include <cmath>

namespace depth_fusion {

// Returns 1, 2 or 5 times a power of ten, so that about six steps fit into the extent.
inline double niceStep(double extent) {
  const double rough = extent / 6.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace depth_fusion
