// What a frame's own points say, before any of them is matched.
#pragma once

#include <Eigen/Geometry>

#include "depth_fusion/frames/depth_frame.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// The cube that points with the mean and spread of the level's would fill evenly, seen from M. They count by
// the sensor's accuracy, as they do in the system: a few points far away would make the box large and all
// rotations weak. A cube, for the lever arms of a rotation about an axis lie across it: the box's own sizes
// (the paper's S) would scale them wrongly.
Eigen::AlignedBox3d spreadBox(const DepthLevel& level, const Pose& T_M_D);

// How much the level's points would say of a motion along the twist, in M, if all of them were matched: the
// mean of their squared Jacobians, by the sensor's accuracy, as an eigenvalue of the system is.
double informationAlong(const Vector6d& twist, const DepthLevel& level, const Pose& T_M_D);

}  // namespace depth_fusion
