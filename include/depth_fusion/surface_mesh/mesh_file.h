// Mesh files of several formats.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// Names the formats: "ply" (binary, with normals and colours), "obj" (text, with normals and colours) and
// "stl" (binary, with neither).
const std::vector<std::string>& meshFormats();

// Streams a mesh to a file of the given format; with an empty format the path's ending decides. The memory
// used does not depend on the mesh. The file appears when finish() has succeeded; otherwise nothing is left
// of it, and a file that stood there stays. Throws Error for an unknown format, with the names of the known
// ones, and if the file cannot be created.
std::unique_ptr<MeshSink> createMeshFile(const std::string& path, const std::string& format = "");

}  // namespace depth_fusion
