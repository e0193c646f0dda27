// Meshes of a size that a browser takes, and how they get there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// Returns the mesh with so many vertices at most: those in a cube become their mean, colours and normals,
// too. The triangles stay of even size, so that colours on large planes are not lost. A mesh that has no more
// is returned as it is.
TriangleMesh thinned(const TriangleMesh& mesh, size_t max_vertices);

// The mesh and the sensor's way as an element for the script of model_viewer.js, which says what the bytes
// are. Throws Error for a mesh without vertices.
std::string modelElement(const TriangleMesh& mesh, const Trajectory& trajectory);

}  // namespace depth_fusion
