// How far a mesh is from a scene's exact surface.
#pragma once

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "tools/evaluation/statistics.h"
#include "tools/simulation/scene.h"

namespace depth_fusion {

struct MeshError {
  size_t triangles = 0;
  double area_m2 = 0.0;
  ErrorStatistics vertices_m;  // distance of each vertex to the surface
  ErrorStatistics surface_m;   // of points spread evenly over the triangles' area
};

// T_W_M maps the mesh into the scene's world. Throws Error for a mesh without triangles.
MeshError compareMesh(const TriangleMesh& mesh, const Pose& T_W_M, const Scene& scene,
                      int surface_samples = 500000);

// Colours the vertices by their distance to the surface: blue at 0, over green to red at full_scale_m and
// beyond.
void paintError(TriangleMesh& mesh, const Pose& T_W_M, const Scene& scene, double full_scale_m);

}  // namespace depth_fusion
