#include "apps/reconstruct/page.h"

#include <filesystem>
#include <iostream>

#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/frames/y_down.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "tools/report/run_report.h"
#include "tools/simulation/scene_library.h"

namespace depth_fusion {
namespace {

constexpr int kSurfaceSamples = 100000;

std::string nameOf(const std::string& input) {
  const std::filesystem::path path = std::filesystem::absolute(input).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::vector<ReportParameter> parametersOf(PipelineParameters used) {
  PipelineParameters usual;
  const ParameterTable table = usual.table();
  std::vector<ReportParameter> parameters;
  for (const Parameter& parameter : used.table())
    parameters.push_back({parameter.name, valueText(parameter),
                          valueText(findParameter(table, parameter.name)), helpText(parameter)});
  return parameters;
}

// A recording without truth is none that has errors.
void measure(const std::string& folder, RunReport& report) {
  try {
    Trajectory truth = readPoses(folder);
    if (report.record.yMirrored()) {
      for (StampedPose& pose : truth) pose.T_W_D = mirroredY(pose.T_W_D);
    }
    report.trajectory_error = compareTrajectories(report.trajectory, truth);
    if (report.mesh.triangles.empty()) return;
    const Scene scene = makeScene(findSceneName(folder + "/")).surface;
    const Pose& T_W_M = report.trajectory_error->T_W_E;
    report.mesh_error = compareMesh(report.mesh, T_W_M, scene, kSurfaceSamples);
    report.error_map = report.mesh;
    paintError(report.error_map, T_W_M, scene, report.error_full_scale_m);
  } catch (const Error&) {
  }
}

void addCosts(RunReport& report, ReconstructionPipeline& pipeline) {
  const BlockMap::Usage pool = pipeline.map().usage();
  report.stages_ms = pipeline.timers().samplesMs();
  report.pool_blocks = pool.blocks;
  report.pool_capacity = pool.capacity;
  report.pool_bytes = static_cast<double>(pool.pool_bytes);
  report.map_bytes =
      static_cast<double>(mapBytes(pipeline.map().parameters(), pipeline.submaps().blockCount()));
  report.peak_rss_bytes = static_cast<double>(peakRssBytes());
}

}  // namespace

void writePage(const RunOptions& options, ComputeContext& compute, ReconstructionPipeline& pipeline,
               const RunLog& log) {
  RunReport report;
  addCosts(report, pipeline);
  report.name = nameOf(options.inputs.front());
  report.input = log.input();
  report.device = compute.selfTestReport();
  report.record = log.record();
  report.trajectory = log.trajectory();
  const RunCounts& counts = log.counts();
  report.map_doubt = counts.map_doubt;
  report.unreadable = counts.unreadable;
  report.colored = counts.colored;
  report.wants_color = options.parameters.map.color;
  report.loops = counts.loops;
  report.moved_by_loops_m = counts.moved_by_loops_m;
  report.parameters = parametersOf(options.parameters);
  if (!options.no_mesh && counts.tracked > 0) {
    report.mesh = readPly(options.output + "/mesh.ply");
    report.viewer_command = "scripts/run view " + options.output;
  }
  if (options.inputs.size() == 1 && std::filesystem::is_directory(options.inputs.front()))
    measure(options.inputs.front(), report);
  const std::string path = options.output + "/report.html";
  writeText(path, pageOf(report));
  std::cout << path << ": open it in a browser" << std::endl;
}

}  // namespace depth_fusion
