// OBJ files with the colours of vertices, which the readers of PCL and VTK leave out.
#pragma once

#include <string>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// Reads positions, faces and, where all vertices have some, colours. Normals are those of the faces. Throws
// Error, which names the path, if it cannot be read or a face names a vertex that is not there.
TriangleMesh readObj(const std::string& path);

// Gives each vertex the mean normal of its triangles, by their area.
void setNormals(TriangleMesh& mesh);

}  // namespace depth_fusion
