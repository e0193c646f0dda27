// Where a sensor is searched for.
#pragma once

#include <vector>

#include "depth_fusion/frames/motion_prior.h"

namespace depth_fusion {

// Poses about one that was given by eye, the pose itself first: aside, ahead and turned, to half a metre and
// 20 degrees.
std::vector<Pose> aboutGiven(const Pose& T_W_D);

// Poses that a sensor may have got to from where it was seen last: turned by up to 40 degrees, and moved by
// half a metre.
std::vector<Pose> aboutLastSeen(const Pose& T_W_D);

// Poses as far about one with a covariance as that says, two standard deviations at most, along its axes;
// none where it is so small that a search from the pose itself finds all of them.
std::vector<Pose> aboutBridged(const MotionPrior& prior);

}  // namespace depth_fusion
