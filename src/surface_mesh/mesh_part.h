// Parts of meshes.
#pragma once

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// The given triangles of vertices of the mesh, with the vertices that they use and no others, in the order of
// their first use.
TriangleMesh partOf(const TriangleMesh& mesh, const std::vector<MeshTriangle>& triangles);

}  // namespace depth_fusion
