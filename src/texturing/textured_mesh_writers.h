// Writers of textured meshes, a format each. The mesh's own file appears last, and only if all of its files
// could be written. Each throws Error if one cannot be.
#pragma once

#include <string>

#include "depth_fusion/texturing/textured_mesh.h"

namespace depth_fusion {

void writeTexturedObj(const std::string& path, const TexturedMesh& mesh);
void writeTexturedPly(const std::string& path, const TexturedMesh& mesh);
void writeTexturedGlb(const std::string& path, const TexturedMesh& mesh, UpAxis up);

}  // namespace depth_fusion
