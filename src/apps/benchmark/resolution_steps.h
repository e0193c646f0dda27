// What the benchmarks over the voxel resolution have in common: inputs, and maps of more and more voxels in
// one box.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "apps/benchmark/tracking_inputs.h"

namespace depth_fusion {

struct ResolutionOptions {
  std::string output = "docs";
  std::string data;  // folder of the real recordings; those that are not there are left out
  std::string cfg = "cfg";
  std::string device;
  std::vector<std::string> inputs = {"room", "tum_fr1_xyz"};
  std::vector<int> voxels_per_axis;
  size_t frames = 0;
  double box_m = 6.0;
  size_t limit_mib = 1536;
};

void addResolutionOptions(CLI::App& command, ResolutionOptions& options);

// Returns the simulated room and tum_fr1_xyz with its camera file, by name. Throws Error for an input that is
// not known.
std::vector<TrackingInput> resolutionInputs(const ResolutionOptions& options);

// Returns the input's first frames, to be run through more than once.
std::vector<RgbdFrame> firstFrames(const TrackingInput& input, size_t count);

// Sets up a map with blocks of 8^3; what the limit leaves beside the offsets is the pool. Throws Error if
// nothing is left.
MapParameters mapInBox(const ResolutionOptions& options, int voxels_per_axis);

// Returns the sum of the medians of the stage's timers, those within it included.
double stageMedian_ms(const StageTimers& timers, const std::string& stage);

}  // namespace depth_fusion
