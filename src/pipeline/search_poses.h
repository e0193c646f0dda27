// Where a sensor is searched for.
#pragma once

#include <vector>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Poses about one that was given by eye, the pose itself first: aside, ahead and turned, to half a metre and
// 20 degrees.
std::vector<Pose> aboutGiven(const Pose& T_W_D);

// Poses that a sensor may have got to from where it was seen last: turned by up to 40 degrees, and moved by
// half a metre.
std::vector<Pose> aboutLastSeen(const Pose& T_W_D);

}  // namespace depth_fusion
