// Degrees and radians.
#pragma once

namespace depth_fusion {

constexpr double kRadPerDeg = 3.141592653589793 / 180.0;
constexpr double kDegPerRad = 180.0 / 3.141592653589793;

}  // namespace depth_fusion
