#include <algorithm>
#include <filesystem>

#include "depth_fusion/common/error.h"
#include "texturing/textured_mesh_writers.h"

namespace depth_fusion {
namespace {

std::string formatOf(const std::string& path, const std::string& format) {
  return format.empty() ? endingOf(path) : format;
}

}  // namespace

void checkTexturedPath(const std::string& path, const std::string& format) {
  const std::string chosen = formatOf(path, format);
  check(chosen == "obj" || chosen == "glb" || chosen == "ply",
        "textured mesh " + path + ": " +
            (format.empty() ? "its name must end in .obj, .glb or .ply"
                            : "its format must be obj, glb or ply") +
            ", which have textures");
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  check(folder.empty() || std::filesystem::is_directory(folder),
        "textured mesh " + path + ": the folder " + folder.string() + " does not exist");
}

void writeTexturedMesh(const std::string& path, const TexturedMesh& mesh, UpAxis up,
                       const std::string& format) {
  checkTexturedPath(path, format);
  const std::string chosen = formatOf(path, format);
  if (chosen == "glb") writeTexturedGlb(path, mesh, up);
  if (chosen == "obj") writeTexturedObj(path, mesh);
  if (chosen == "ply") writeTexturedPly(path, mesh);
}

}  // namespace depth_fusion
