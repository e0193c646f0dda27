// Meshes of fewer triangles.
#pragma once

#include <cstddef>
#include <limits>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// What becomes of the vertices at the mesh's open borders. They must stay if a mesh is simplified piece by
// piece.
enum class OpenBorders { kMayMove, kStay };

// Whether depth_fusion was built with meshoptimizer, which simplifies meshes.
bool canSimplify();

// Returns the mesh with the share `ratio`, above 0 and up to 1, of its triangles, or with as few more as its
// topology allows: edges collapse where that moves the surface least. The vertices that are left keep
// position, normal and colour. Throws Error for another ratio, and for one below 1 where depth_fusion was
// built without meshoptimizer.
TriangleMesh simplified(const TriangleMesh& mesh, double ratio, OpenBorders borders = OpenBorders::kMayMove);

// How far a mesh is simplified: until it has so few triangles, or until one more step would move the surface
// by more than the error, whichever comes first.
struct SimplificationGoal {
  size_t triangles = 0;
  double max_error_m = std::numeric_limits<double>::infinity();
};

// Throws Error where depth_fusion was built without meshoptimizer.
TriangleMesh simplified(const TriangleMesh& mesh, const SimplificationGoal& goal,
                        OpenBorders borders = OpenBorders::kMayMove);

}  // namespace depth_fusion
