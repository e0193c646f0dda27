// Models and trajectories turned so that they stand upright.
#pragma once

#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// Returns the rotation that takes W into a level frame: its y points down, as most of the floors and table
// tops say that are found to look up in W, where y is roughly down. Without any it is the identity.
Eigen::Matrix3d levelFrom(const TriangleMesh& mesh);

TriangleMesh rotated(const Eigen::Matrix3d& rotation, const TriangleMesh& mesh);
Trajectory rotated(const Eigen::Matrix3d& rotation, const Trajectory& trajectory);

}  // namespace depth_fusion
