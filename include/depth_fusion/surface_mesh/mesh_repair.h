// Meshes without islands and holes.
#pragma once

#include <cstddef>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

struct IslandRemoval {
  TriangleMesh mesh;
  size_t removed = 0;  // islands
};

// Islands are parts of the surface that share no vertex with others. Those whose box has a diagonal below
// min_size_m are removed.
IslandRemoval withoutIslands(const TriangleMesh& mesh, double min_size_m);

struct HoleClosing {
  TriangleMesh mesh;
  size_t closed = 0, left = 0;  // holes; the outline of an open surface is one of them
};

// Holes whose border's box has a diagonal of max_size_m at most are closed by the triangles of the least area
// between the vertices of their borders; no vertex is added. A hole of more than 500 edges is left, and one
// that cannot be closed without a third triangle at an edge.
HoleClosing withHolesClosed(const TriangleMesh& mesh, double max_size_m);

}  // namespace depth_fusion
