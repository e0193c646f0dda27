// Parts of meshes.
#pragma once

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// Returns a mesh of the given triangles, which name vertices of `mesh`, with the vertices that they use and
// no others, in the order of their first use.
TriangleMesh partOf(const TriangleMesh& mesh, const std::vector<MeshTriangle>& triangles);

}  // namespace depth_fusion
