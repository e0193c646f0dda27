// Mesh files of several formats.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// The formats: "ply" (binary, normals and colours), "obj" (text, normals and colours) and "stl" (binary,
// neither).
const std::vector<std::string>& meshFormats();

// Streams a mesh to a file of one of the formats; an empty one means that of the path's ending. The memory
// used does not depend on the mesh. The file appears when finish() succeeded; else nothing is left, and a
// file that stood there stays. Throws Error for an unknown format, naming those there are, and if the file
// cannot be created.
std::unique_ptr<MeshSink> createMeshFile(const std::string& path, const std::string& format = "");

}  // namespace depth_fusion
