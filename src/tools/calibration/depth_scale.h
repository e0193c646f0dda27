// The factor on the depth, which no depth sensor can know without a length from outside.
#pragma once

#include "depth_fusion/geometry/pose.h"
#include "tools/calibration/depth_calibration.h"

namespace depth_fusion {

// Finds the factor by which the tracked trajectory gets the size of the true one. Throws Error if the true
// one covers too little of it.
Estimate scaleAgainst(const Trajectory& tracked, const Trajectory& truth);

// Finds the same from the straight distance between the first and the last pose, measured to +-sigma.
Estimate scaleAgainst(const Trajectory& tracked, const Estimate& distance_m);

}  // namespace depth_fusion
