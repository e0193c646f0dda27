// Mesh files of several formats.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// Names the formats: "ply" (binary, with normals and colours), "obj" (text, with normals and colours), "stl"
// (binary, with neither), "glb" (binary glTF 2.0, with both), "dae" (COLLADA, with both) and "pcd" (binary,
// the vertices with both).
const std::vector<std::string>& meshFormats();

// Where up is in the mesh's frame. Formats whose own frame has an axis for it, glb and dae, turn the mesh;
// the others have its coordinates as they are.
enum class UpAxis {
  kMinusY,  // of a camera that was held level
  kZ,       // of a robot's map
};

// The path's ending, in lower case and without its point.
std::string endingOf(const std::string& path);

// Streams a mesh to a file of the given format, in metres; with an empty format the path's ending decides.
// The memory used does not depend on the mesh. The file appears when finish() has succeeded; otherwise
// nothing is left of it, and a file that stood there stays. Throws Error for an unknown format, with the
// names of the known ones, and if the file cannot be created.
std::unique_ptr<MeshSink> createMeshFile(const std::string& path, const std::string& format = "",
                                         UpAxis up = UpAxis::kMinusY);

}  // namespace depth_fusion
