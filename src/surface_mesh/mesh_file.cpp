#include "depth_fusion/surface_mesh/mesh_file.h"

#include <algorithm>
#include <filesystem>

#include "common/lowered.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "surface_mesh/dae_writer.h"
#include "surface_mesh/glb_writer.h"
#include "surface_mesh/obj_writer.h"
#include "surface_mesh/pcd_writer.h"
#include "surface_mesh/stl_writer.h"

namespace depth_fusion {
namespace {

std::string choices() {
  std::string text;
  for (const std::string& format : meshFormats()) text += (text.empty() ? "" : ", ") + format;
  return text;
}

}  // namespace

const std::vector<std::string>& meshFormats() {
  static const std::vector<std::string> formats = {"ply", "obj", "stl", "glb", "dae", "pcd"};
  return formats;
}

std::string endingOf(const std::string& path) {
  const std::string ending = lowered(std::filesystem::path(path).extension().string());
  return ending.empty() ? ending : ending.substr(1);
}

std::unique_ptr<MeshSink> createMeshFile(const std::string& path, const std::string& format, UpAxis up) {
  const std::string chosen = format.empty() ? endingOf(path) : format;
  if (chosen == "ply") return std::make_unique<PlyWriter>(path);
  if (chosen == "obj") return std::make_unique<ObjWriter>(path);
  if (chosen == "stl") return std::make_unique<StlWriter>(path);
  if (chosen == "glb") return std::make_unique<GlbWriter>(path, up);
  if (chosen == "dae") return std::make_unique<DaeWriter>(path, up);
  if (chosen == "pcd") return std::make_unique<PcdWriter>(path);
  throw Error(
      "mesh file " + path + ": " +
      (chosen.empty() ? "its name has no ending and no format is given" : "unknown format '" + chosen + "'") +
      "; choose one of " + choices());
}

}  // namespace depth_fusion
