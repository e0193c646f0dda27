// Points that are spread over a surface.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

struct PointOnMesh {
  Eigen::Vector3f p_W, normal_W;
};

// About so many points, the same at every call, as dense everywhere.
std::vector<PointOnMesh> pointsOn(const TriangleMesh& mesh, size_t count);

// The normal of a triangle, as long as twice its area.
Eigen::Vector3f areaNormal(const TriangleMesh& mesh, const MeshTriangle& triangle);

}  // namespace depth_fusion
