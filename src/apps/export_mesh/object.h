// An object that stands on something, taken out of what was scanned.
#pragma once

#include <array>
#include <optional>

#include "depth_fusion/surface_mesh/mesh_finish.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

struct ObjectOptions {
  std::optional<std::array<float, 6>> crop_m;  // least x, y, z, then most: what reaches out of it goes
  float ground_m = 0.0f;  // the largest plane goes, with what is below or less than this above; 0: nothing
  bool closed = false;    // what was not seen is closed smoothly

  bool changesMesh() const { return crop_m || ground_m > 0.0f || closed; }
};

// Crops first, then removes the ground and closes. Throws Error if nothing is left, and if depth_fusion was
// built without what it needs.
FinishedMesh objectOf(TriangleMesh mesh, const ObjectOptions& options);

// The largest plane among the vertices, of which the normal (x, y, z, of length 1) points to the side that
// most of the others are on; w is such that points of the plane have x, y, z times the normal plus w equal to
// 0.
Eigen::Vector4f groundOf(const TriangleMesh& mesh);

// A closed surface near the mesh by Poisson reconstruction (M. Kazhdan), about as fine, with its colours.
TriangleMesh closedModel(const TriangleMesh& mesh);

}  // namespace depth_fusion
