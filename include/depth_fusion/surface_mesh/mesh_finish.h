// What is done to a mesh before it is exported.
#pragma once

#include <string>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

struct MeshFinish {
  double min_island_m = 0.0;  // smaller parts of the surface are removed
  double max_hole_m = 0.0;    // holes up to this size are closed
  double share = 1.0;         // of the triangles that are kept
  size_t max_triangles = 0;   // 0: as many as there are
  double max_error_m =
      0.0;  // of the simplification; 0: none is done but for the two above, whatever the error

  // Whether the mesh has to be in memory for it.
  bool changesMesh() const;
};

struct FinishedMesh {
  TriangleMesh mesh;
  std::string remark;  // what was done, for the user; empty: nothing
};

// Islands are removed first, then holes closed, then triangles collapsed. Throws Error for numbers that make
// no sense, and where the mesh is to be simplified and depth_fusion was built without meshoptimizer.
FinishedMesh finished(TriangleMesh mesh, const MeshFinish& finish);

// Throws Error for numbers that make no sense.
void checkFinish(const MeshFinish& finish);

}  // namespace depth_fusion
