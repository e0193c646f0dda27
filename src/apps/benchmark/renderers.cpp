#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "apps/benchmark/resolution.h"
#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "depth_fusion/common/error.h"
#include "tools/plots/line_plot.h"

namespace depth_fusion {
namespace {

constexpr int kViews = 5, kRepetitions = 3;
constexpr char kRendererTableHead[] =
    "input,voxels per axis,N,M,voxel [mm],blocks,ray casting [ms],marching cubes [ms]\n";

struct Comparison {
  MapParameters map;
  size_t blocks = 0;
  double ray_casting_ms = 0.0, marching_cubes_ms = 0.0;
};

// Runs both renderers in turn, from several of the poses.
Comparison compare(ComputeContext& compute, PipelineParameters parameters, const MapParameters& map,
                   const std::vector<RgbdFrame>& frames) {
  parameters.map = map;
  const CameraIntrinsics camera = frames.front().intrinsics;
  ReconstructionPipeline pipeline(compute, parameters, camera);
  std::vector<Pose> poses;
  for (const RgbdFrame& frame : frames) {
    const TrackingResult tracking = pipeline.processFrame(frame).tracking;
    if (tracking.status != TrackingStatus::kLost) poses.push_back(tracking.T_W_D);
  }
  check(!poses.empty(), "no frame could be tracked");
  ModelViewRenderer rays(compute, pipeline.map(), camera, {"ray_casting"});
  ModelViewRenderer triangles(compute, pipeline.map(), camera, {"marching_cubes"});
  const DepthRange range = parameters.depthRange();
  const auto time = [&](ModelViewRenderer& renderer, const Pose& T_W_D, StageTimers& timers) {
    StageTimers stages;
    const StageTimers::Scope timer(timers, "view");
    renderer.render(T_W_D, range.min_m, range.max_m, stages);
  };
  StageTimers ray_times, triangle_times, warm_up;
  for (ModelViewRenderer* renderer : {&rays, &triangles}) time(*renderer, poses.front(), warm_up);
  for (int i = 0; i < kViews * kRepetitions; ++i) {
    const Pose& T_W_D = poses[(i % kViews + 1) * (poses.size() - 1) / kViews];
    time(rays, T_W_D, ray_times);
    time(triangles, T_W_D, triangle_times);
  }
  return {map, pipeline.map().usage().blocks, stageMedian_ms(ray_times, "view"),
          stageMedian_ms(triangle_times, "view")};
}

std::string rendererRow(const std::string& input, const Comparison& comparison) {
  const int n = comparison.map.blocks_per_axis, m = comparison.map.block_size;
  char row[200];
  std::snprintf(row, sizeof(row), "%s,%d,%d,%d,%.3f,%zu,%.2f,%.2f\n", input.c_str(), n * m, n, m,
                1000.0 * comparison.map.voxel_size_m, comparison.blocks, comparison.ray_casting_ms,
                comparison.marching_cubes_ms);
  return row;
}

void addLines(LinePlot& plot, const std::string& input, const std::vector<Comparison>& comparisons) {
  PlotLine rays{"rays, " + input, {}}, triangles{"triangles, " + input, {}};
  for (const Comparison& comparison : comparisons) {
    const double voxels = comparison.map.blocks_per_axis * comparison.map.block_size;
    rays.points.emplace_back(voxels, comparison.ray_casting_ms);
    triangles.points.emplace_back(voxels, comparison.marching_cubes_ms);
  }
  plot.lines.push_back(rays);
  plot.lines.push_back(triangles);
}

void compareRenderers(const ResolutionOptions& options) {
  std::filesystem::create_directories(options.output);
  ComputeContext compute(options.device);
  std::string table = kRendererTableHead;
  std::printf("%s", kRendererTableHead);
  char title[200];
  std::snprintf(title, sizeof(title), "ray casting and marching cubes, 640x480, box of %.3g m",
                options.box_m);
  LinePlot plot{title, "voxels per axis of the box", "median time a view [ms]", {}, true};
  for (const TrackingInput& input : resolutionInputs(options)) {
    const std::vector<RgbdFrame> frames = firstFrames(input, options.frames);
    std::vector<Comparison> comparisons;
    for (const int voxels : options.voxels_per_axis) {
      comparisons.push_back(compare(compute, input.parameters, mapInBox(options, voxels), frames));
      table += rendererRow(input.name, comparisons.back());
      std::printf("%s", rendererRow(input.name, comparisons.back()).c_str());
      std::fflush(stdout);
    }
    addLines(plot, input.name, comparisons);
  }
  const std::string path = options.output + "/renderers";
  writeText(path + ".csv", table);
  writePicture(path + ".png", draw(plot));
}

}  // namespace

void addRenderersBenchmark(CLI::App& app, ResolutionOptions& options) {
  options.voxels_per_axis = {128, 256, 512, 1024, 2048, 3072, 4096, 5000};
  options.frames = 30;
  CLI::App* command =
      app.add_subcommand("renderers", "ray casting and marching cubes by voxel resolution, in one box");
  addResolutionOptions(*command, options);
  command->callback([&options] { compareRenderers(options); });
}

}  // namespace depth_fusion
