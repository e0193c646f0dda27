// Writes the surface of a map that was saved, or a mesh, in another format.
#include <algorithm>

#include "apps/command_line.h"
#include "apps/export_mesh/object.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/submaps/map_file.h"
#include "depth_fusion/submaps/world_mesh.h"
#include "depth_fusion/surface_mesh/mesh_file.h"
#include "depth_fusion/surface_mesh/mesh_finish.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "pipeline/open_map.h"

namespace depth_fusion {
namespace {

constexpr char kDescription[] =
    "Writes the surface of a map that was saved, or a binary PLY mesh, as PLY, OBJ, STL, glTF binary "
    "(.glb),\n"
    "COLLADA (.dae) or point cloud (.pcd), in metres. It can be cropped, taken off the ground and closed,\n"
    "islands can be removed, holes closed, and triangles saved.\n\n"
    "Examples:\n"
    "  export_mesh room.map --output room.glb\n"
    "  export_mesh out/mesh.ply --output room.dae --min-island 0.2 --max-hole 0.1 --share 0.1\n"
    "  export_mesh out/mesh.ply --output room.stl --max-error 0.002\n"
    "  export_mesh out/mesh.ply --output figure.stl --crop=-0.1,-0.1,0.2,0.1,0.1,0.5 --remove-ground 0.002 "
    "--close\n";

struct Arguments {
  std::string input, output, device;
  bool z_up = false;
  std::vector<float> crop_m;
  ObjectOptions object;
  MeshFinish finish;

  bool changesMesh() const { return finish.changesMesh() || object.changesMesh(); }
};

void addOptions(CLI::App& app, Arguments& arguments) {
  MeshFinish& finish = arguments.finish;
  app.add_option("input", arguments.input,
                 "a map's file, postgresql://USER@HOST/DATABASE#NAME, or a binary PLY file (*.ply)")
      ->required();
  app.add_option("-o,--output", arguments.output, "the mesh to write; its ending is the format")->required();
  app.add_option("--crop", arguments.crop_m,
                 "least x, y and z, then most: what reaches out of this box goes, metres")
      ->delimiter(',')
      ->expected(6);
  app.add_option("--remove-ground", arguments.object.ground_m,
                 "the largest plane goes, and what is below it or less than this above it, metres")
      ->check(CLI::PositiveNumber);
  app.add_flag("--close", arguments.object.closed,
               "a closed model: what was not seen is filled in smoothly (Poisson reconstruction)");
  app.add_option("--min-island", finish.min_island_m,
                 "parts of the surface that are smaller are removed, metres across")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--max-hole", finish.max_hole_m, "holes up to this size are closed, metres across")
      ->check(CLI::Range(0.0, 1e6));
  app.add_option("--share", finish.share, "of the triangles to keep, above 0 and up to 1");
  app.add_option("--triangles", finish.max_triangles, "to keep at most");
  app.add_option("--max-error", finish.max_error_m,
                 "by which simplification may move the surface, metres; alone: as few triangles as it allows")
      ->check(CLI::Range(0.0, 1e6));
  app.add_flag(
      "--z-up", arguments.z_up,
      "up is z, as in a robot's map; without it -y, as of a level camera. glb and dae are turned by it");
  app.add_option("--device", arguments.device, "OpenCL device: index, part of its name, cpu or gpu");
}

void exportMap(const Arguments& arguments, MeshSink& sink) {
  const auto database = openDatabase(arguments.input, DatabaseAccess::kRead);
  ComputeContext compute(arguments.device);
  OpenMap map(compute, {}, *database);
  map.exportMesh(sink);
}

// The surface, changed as it is wanted.
FinishedMesh changedMesh(const Arguments& arguments) {
  TriangleMesh mesh;
  if (endingOf(arguments.input) == "ply")
    mesh = readPly(arguments.input);
  else
    exportMap(arguments, mesh);
  FinishedMesh object = objectOf(std::move(mesh), arguments.object);
  FinishedMesh result = finished(std::move(object.mesh), arguments.finish);
  const bool says_both = !object.remark.empty() && !result.remark.empty();
  result.remark = object.remark + (says_both ? ", " : "") + result.remark;
  return result;
}

void exportMesh(const Arguments& arguments) {
  checkFinish(arguments.finish);
  const auto file = createMeshFile(arguments.output, "", arguments.z_up ? UpAxis::kZ : UpAxis::kMinusY);
  if (endingOf(arguments.input) != "ply" && !arguments.changesMesh()) {
    exportMap(arguments, *file);
    std::cout << arguments.output << ": written\n";
    return;
  }
  const auto [mesh, remark] = changedMesh(arguments);
  sendMesh(mesh, *file);
  std::cout << arguments.output << ": " << mesh.vertices.size() << " vertices, " << mesh.triangles.size()
            << " triangles" << (remark.empty() ? "" : "; " + remark) << "\n";
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  using namespace depth_fusion;
  CLI::App app(kDescription, "export_mesh");
  Arguments arguments;
  addOptions(app, arguments);
  return runApp(app, [&] {
    app.parse(argc, argv);
    if (!arguments.crop_m.empty()) {
      arguments.object.crop_m.emplace();
      std::copy(arguments.crop_m.begin(), arguments.crop_m.end(), arguments.object.crop_m->begin());
    }
    exportMesh(arguments);
    return 0;
  });
}
