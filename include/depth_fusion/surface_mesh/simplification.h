// Meshes of fewer triangles.
#pragma once

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// What becomes of the vertices at the mesh's open borders. They must stay if a mesh is simplified piece by
// piece.
enum class OpenBorders { kMayMove, kStay };

// Whether depth_fusion was built with meshoptimizer, which simplifies meshes.
bool canSimplify();

// The share `ratio`, above 0 and up to 1, of the mesh's triangles, or as few more as its topology allows:
// edges collapse where that moves the surface least. The vertices left keep position, normal and colour. All
// of it happens in memory. Throws Error for another ratio, and for one below 1 where depth_fusion was built
// without meshoptimizer.
TriangleMesh simplified(const TriangleMesh& mesh, double ratio, OpenBorders borders = OpenBorders::kMayMove);

}  // namespace depth_fusion
