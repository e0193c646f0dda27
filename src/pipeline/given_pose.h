// Where somebody says by eye that a lost sensor is.
#pragma once

#include <vector>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Poses about one that was given, the pose itself first: aside, ahead and turned, to half a metre and 20
// degrees.
std::vector<Pose> aboutGiven(const Pose& T_W_D);

}  // namespace depth_fusion
