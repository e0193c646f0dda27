// Normals of meshes that have none.
#pragma once

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// Gives each vertex the mean normal of its triangles, by their area.
void setNormals(TriangleMesh& mesh);

}  // namespace depth_fusion
