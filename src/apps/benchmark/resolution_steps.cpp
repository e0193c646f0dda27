#include "apps/benchmark/resolution_steps.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "depth_fusion/common/error.h"
#include "depth_fusion/common/percentile.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr int kBlockSize = 8;
constexpr size_t kLargestPool_MiB = 2047;

std::optional<TrackingInput> desk(const ResolutionOptions& options) {
  TrackingBenchmark tracking;
  tracking.data = dataFolder(options.data);
  tracking.cfg = options.cfg;
  tracking.inputs = {"tum_fr1_xyz"};
  if (std::filesystem::exists(tracking.data + "/tum_fr1_xyz")) return trackingInputs(tracking).front();
  std::cout << "tum_fr1_xyz is not in " << tracking.data << " and left out; see --data" << std::endl;
  return std::nullopt;
}

}  // namespace

void addResolutionOptions(CLI::App& command, ResolutionOptions& options) {
  command.add_option("-o,--output", options.output, "folder for tables (.csv) and plots (.png)")
      ->capture_default_str();
  command.add_option("--data", options.data,
                     "folder of the real recordings [$DEPTH_FUSION_DATA or ../shared/data]");
  command.add_option("--cfg", options.cfg, "folder of the sensors' parameter files")->capture_default_str();
  command.add_option("--device", options.device, "OpenCL device, as of reconstruct");
  command.add_option("--input", options.inputs, "room, tum_fr1_xyz")->capture_default_str();
  command.add_option("--voxels", options.voxels_per_axis, "voxels per axis of the box, multiples of 8")
      ->check(CLI::Range(64, 10240))
      ->capture_default_str();
  command.add_option("--frames", options.frames, "frames of each input")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  command.add_option("--box", options.box_m, "edge of the window in metres")->capture_default_str();
  command.add_option("--limit", options.limit_mib, "memory of the map, MiB")->capture_default_str();
}

std::vector<TrackingInput> resolutionInputs(const ResolutionOptions& options) {
  std::vector<TrackingInput> inputs;
  for (const std::string& name : options.inputs) {
    check(name == "room" || name == "tum_fr1_xyz",
          "there is no input '" + name + "'; the inputs are: room, tum_fr1_xyz");
    const std::optional<TrackingInput> input =
        name == "room" ? roomInput(SimulationOptions().frames) : desk(options);
    if (input) inputs.push_back(*input);
  }
  return inputs;
}

std::vector<RgbdFrame> firstFrames(const TrackingInput& input, size_t count) {
  const std::unique_ptr<Recording> recording = input.open();
  std::vector<RgbdFrame> frames;
  while (frames.size() < count) {
    std::optional<RgbdFrame> frame = recording->next();
    if (!frame) break;
    frames.push_back(std::move(*frame));
  }
  check(!frames.empty(), input.name + " has no frames");
  return frames;
}

MapParameters mapInBox(const ResolutionOptions& options, int voxels_per_axis) {
  MapParameters map;
  map.block_size = kBlockSize;
  map.blocks_per_axis = (voxels_per_axis + kBlockSize - 1) / kBlockSize;
  map.voxel_size_m = static_cast<float>(options.box_m / voxels_per_axis);
  const size_t offset_mib = (mapBytes(map, 0) + (1 << 20) - 1) >> 20;
  check(offset_mib < options.limit_mib,
        std::to_string(voxels_per_axis) + " voxels an axis do not fit into --limit");
  map.pool_mib = static_cast<int>(std::min(options.limit_mib - offset_mib, kLargestPool_MiB));
  return map;
}

double stageMedian_ms(const StageTimers& timers, const std::string& stage) {
  double sum_ms = 0.0;
  for (const auto& [name, samples_ms] : timers.samplesMs()) {
    if (name == stage || name.compare(0, stage.size() + 1, stage + "/") == 0)
      sum_ms += percentile(samples_ms, 0.5);
  }
  return sum_ms;
}

}  // namespace depth_fusion
