// Measures trajectories against ground truth and meshes against the exact surface of a built-in scene.
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/command_line.h"
#include "common/io/image_file.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "tools/evaluation/mesh_error.h"
#include "tools/plots/trajectory_plot.h"
#include "tools/simulation/scene_library.h"

namespace depth_fusion {
namespace {

using Json = nlohmann::ordered_json;

struct Arguments {
  std::string trajectory, groundtruth, plot, mesh, scene, error_map;
  double full_scale_m = 0.01;
  TrajectoryErrorOptions options;
  bool json = false;
};

void addOptions(CLI::App& app, Arguments& arguments) {
  auto* trajectory =
      app.add_option("-t,--trajectory", arguments.trajectory, "estimated trajectory (TUM format)");
  auto* groundtruth = app.add_option("-g,--groundtruth", arguments.groundtruth,
                                     "true trajectory (TUM format), or a recording's folder with poses");
  trajectory->needs(groundtruth);
  app.add_option("-p,--plot", arguments.plot, "picture of both trajectories to write (.png)")
      ->needs(trajectory);
  auto* mesh = app.add_option("-m,--mesh", arguments.mesh, "mesh (binary .ply) to measure");
  auto* scene = app.add_option("-s,--scene", arguments.scene,
                               "the scene the mesh shows: a folder written by simulate, or a scene's name");
  mesh->needs(scene);
  scene->needs(mesh);
  auto* error_map = app.add_option("--error-map", arguments.error_map,
                                   "the mesh coloured by its error to write (.ply), blue where there is none")
                        ->needs(mesh);
  app.add_option("--full-scale", arguments.full_scale_m, "metres of error that are red in the error map")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->needs(error_map);
  app.add_option("--max-gap", arguments.options.max_gap_s,
                 "seconds to the nearest true poses, over which an estimated pose is left out")
      ->capture_default_str();
  app.add_option("--rpe-interval", arguments.options.rpe_interval_s,
                 "seconds over which the relative error is taken")
      ->capture_default_str();
  app.add_flag("-j,--json", arguments.json, "print the result as JSON, in metres and degrees");
  app.footer(
      "A trajectory is aligned rigidly, without scale, before its absolute error (ATE) is taken; the "
      "relative error\n"
      "(RPE) needs no alignment. The mesh is moved into the scene's world, with --trajectory and "
      "--groundtruth by\n"
      "their alignment, with --groundtruth alone by its first pose (a mesh in the frame of the first "
      "camera), with\n"
      "neither not at all (a mesh fused with the true poses).\n\n"
      "Examples: evaluate --trajectory out/trajectory.txt --groundtruth room/groundtruth.txt --plot "
      "error.png\n"
      "          evaluate --mesh out/mesh.ply --scene room \\\n"
      "                   --trajectory out/trajectory.txt --groundtruth room/groundtruth.txt");
}

Json toJson(const ErrorStatistics& statistics) {
  return {{"rmse", statistics.rmse},        {"mean", statistics.mean}, {"median", statistics.median},
          {"p95", statistics.percentile95}, {"max", statistics.max},   {"count", statistics.count}};
}

Json toJson(const TrajectoryError& error) {
  return {{"estimated_poses", error.estimated_poses},
          {"compared_poses", error.pairs.size()},
          {"ate_m", toJson(error.ate_m)},
          {"rpe_translation_m", toJson(error.rpe_translation_m)},
          {"rpe_rotation_deg", toJson(error.rpe_rotation_deg)}};
}

Json toJson(const MeshError& error) {
  return {{"triangles", error.triangles},
          {"area_m2", error.area_m2},
          {"vertices_m", toJson(error.vertices_m)},
          {"surface_m", toJson(error.surface_m)}};
}

void printRow(const char* name, const ErrorStatistics& statistics, double scale, const char* unit) {
  if (statistics.count == 0) {
    std::printf("  %-24s none compared\n", name);
    return;
  }
  std::printf("  %-24s rmse %8.3f  mean %8.3f  median %8.3f  95%% %8.3f  max %8.3f %s\n", name,
              scale * statistics.rmse, scale * statistics.mean, scale * statistics.median,
              scale * statistics.percentile95, scale * statistics.max, unit);
}

void print(const TrajectoryError& error, const TrajectoryErrorOptions& options) {
  std::printf("trajectory: %zu of %zu poses have a true one\n", error.pairs.size(), error.estimated_poses);
  char moved[40], turned[40];
  std::snprintf(moved, sizeof(moved), "relative shift, over %g s", options.rpe_interval_s);
  std::snprintf(turned, sizeof(turned), "relative turn, over %g s", options.rpe_interval_s);
  printRow("absolute (ATE)", error.ate_m, 1000.0, "mm");
  printRow(moved, error.rpe_translation_m, 1000.0, "mm");
  printRow(turned, error.rpe_rotation_deg, 1.0, "deg");
}

void print(const MeshError& error) {
  std::printf("mesh: %zu triangles, %.3f m^2, distance to the true surface\n", error.triangles,
              error.area_m2);
  printRow("of the vertices", error.vertices_m, 1000.0, "mm");
  printRow("of the surface", error.surface_m, 1000.0, "mm");
}

void evaluate(const Arguments& arguments) {
  check(!arguments.trajectory.empty() || !arguments.mesh.empty(),
        "nothing to measure; give --trajectory and --groundtruth, or --mesh and --scene (see --help)");
  Json report = Json::object();
  Pose T_W_M = Pose::Identity();
  if (!arguments.groundtruth.empty()) {
    std::string remark;
    const Trajectory truth = readPoses(arguments.groundtruth, &remark);
    if (!remark.empty()) std::cerr << "evaluate: " << remark << std::endl;
    T_W_M = truth.front().T_W_D;
    if (!arguments.trajectory.empty()) {
      const TrajectoryError error =
          compareTrajectories(readTrajectory(arguments.trajectory), truth, arguments.options);
      T_W_M = error.T_W_E;
      report["trajectory"] = toJson(error);
      if (!arguments.json) print(error, arguments.options);
      if (!arguments.plot.empty()) writePicture(arguments.plot, plotTrajectories(error));
    }
  }
  if (!arguments.mesh.empty()) {
    const Scene scene = makeScene(findSceneName(arguments.scene)).surface;
    TriangleMesh mesh = readPly(arguments.mesh);
    const MeshError error = compareMesh(mesh, T_W_M, scene);
    if (!arguments.error_map.empty()) {
      paintError(mesh, T_W_M, scene, arguments.full_scale_m);
      writePly(arguments.error_map, mesh);
    }
    report["mesh"] = toJson(error);
    if (!arguments.json) print(error);
  }
  if (arguments.json) std::printf("%s\n", report.dump(2).c_str());
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  CLI::App app(
      "Measures trajectories against ground truth, and meshes against the exact surface of a built-in "
      "scene.",
      "evaluate");
  depth_fusion::Arguments arguments;
  addOptions(app, arguments);
  return depth_fusion::runApp(app, [&] {
    app.parse(argc, argv);
    evaluate(arguments);
    return 0;
  });
}
