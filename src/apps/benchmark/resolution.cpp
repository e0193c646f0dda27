#include "apps/benchmark/resolution.h"

#include <cstdio>
#include <filesystem>

#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "tools/plots/line_plot.h"

namespace depth_fusion {
namespace {

constexpr char kTableHead[] =
    "input,voxels per axis,N,M,voxel [mm],frames,lost,left out blocks,blocks,map bytes,"
    "model view [ms],ICP tracking [ms],block selection [ms],integration [ms],frame [ms]\n";

// Medians of a run.
struct StageTimes {
  double model_view_ms = 0.0, icp_tracking_ms = 0.0, selection_ms = 0.0, integration_ms = 0.0, frame_ms = 0.0;
};

struct Outcome {
  MapParameters map;
  BlockMap::Usage usage;
  size_t frames = 0, lost = 0;
  size_t left_out = 0;  // blocks that the pool had no room for
  StageTimes times;
};

StageTimes timesOf(const StageTimers& timers) {
  return {stageMedian_ms(timers, "model_view"), stageMedian_ms(timers, "icp_tracking"),
          stageMedian_ms(timers, "tsdf_fusion/select_blocks"),
          stageMedian_ms(timers, "tsdf_fusion/integrate"), stageMedian_ms(timers, "frame")};
}

Outcome runAt(ComputeContext& compute, PipelineParameters parameters, const MapParameters& map,
              const std::vector<RgbdFrame>& frames) {
  parameters.map = map;
  ReconstructionPipeline pipeline(compute, parameters, frames.front().intrinsics);
  Outcome outcome;
  outcome.map = map;
  for (const RgbdFrame& frame : frames) {
    const FrameResult result = pipeline.processFrame(frame);
    outcome.lost += result.tracking.status == TrackingStatus::kLost;
    outcome.left_out += result.fusion.blocks_requested - result.fusion.blocks_allocated;
  }
  outcome.frames = frames.size();
  outcome.usage = pipeline.map().usage();
  outcome.times = timesOf(pipeline.timers());
  return outcome;
}

std::string tableRow(const std::string& input, const Outcome& outcome) {
  const StageTimes& times = outcome.times;
  const int n = outcome.map.blocks_per_axis, m = outcome.map.block_size;
  char row[300];
  std::snprintf(row, sizeof(row), "%s,%d,%d,%d,%.3f,%zu,%zu,%zu,%zu,%zu,%.2f,%.2f,%.2f,%.2f,%.2f\n",
                input.c_str(), n * m, n, m, 1000.0 * outcome.map.voxel_size_m, outcome.frames, outcome.lost,
                outcome.left_out, outcome.usage.blocks, outcome.usage.bytes, times.model_view_ms,
                times.icp_tracking_ms, times.selection_ms, times.integration_ms, times.frame_ms);
  return row;
}

void writePlot(const std::string& path, const std::string& title, const std::vector<Outcome>& outcomes) {
  LinePlot plot{title, "voxels per axis of the box", "median time a frame [ms]", {}};
  PlotLine model_view{"model view", {}}, icp{"ICP tracking", {}}, selection{"block selection", {}},
      integration{"integration", {}};
  for (const Outcome& outcome : outcomes) {
    const double voxels = outcome.map.blocks_per_axis * outcome.map.block_size;
    model_view.points.emplace_back(voxels, outcome.times.model_view_ms);
    icp.points.emplace_back(voxels, outcome.times.icp_tracking_ms);
    selection.points.emplace_back(voxels, outcome.times.selection_ms);
    integration.points.emplace_back(voxels, outcome.times.integration_ms);
  }
  plot.lines = {model_view, icp, integration, selection};
  writePicture(path, draw(plot));
}

void compareResolutions(const ResolutionOptions& options) {
  std::filesystem::create_directories(options.output);
  ComputeContext compute(options.device);
  std::string table = kTableHead;
  std::printf("%s", kTableHead);
  for (const TrackingInput& input : resolutionInputs(options)) {
    const std::vector<RgbdFrame> frames = firstFrames(input, options.frames);
    std::vector<Outcome> outcomes;
    for (const int voxels : options.voxels_per_axis) {
      outcomes.push_back(runAt(compute, input.parameters, mapInBox(options, voxels), frames));
      table += tableRow(input.name, outcomes.back());
      std::printf("%s", tableRow(input.name, outcomes.back()).c_str());
      std::fflush(stdout);
    }
    char title[200];
    std::snprintf(title, sizeof(title), "%s, 640x480, box of %.3g m, %zu frames", input.name.c_str(),
                  options.box_m, frames.size());
    writePlot(options.output + "/resolution_" + input.name + ".png", title, outcomes);
  }
  writeText(options.output + "/resolution.csv", table);
}

}  // namespace

void addResolutionBenchmark(CLI::App& app, ResolutionOptions& options) {
  options.voxels_per_axis = {512, 1024, 2048, 3072, 4096, 5000};
  options.frames = 120;
  CLI::App* command = app.add_subcommand(
      "resolution", "time of model view, ICP and integration by voxel resolution, in one box");
  addResolutionOptions(*command, options);
  command->callback([&options] { compareResolutions(options); });
}

}  // namespace depth_fusion
