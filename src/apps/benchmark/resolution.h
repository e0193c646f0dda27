// benchmark resolution: the paper's performance figure, time of the stages by voxel resolution.
// benchmark renderers: the paper's comparison of ray casting and marching cubes, by voxel resolution.
#pragma once

#include "apps/benchmark/resolution_steps.h"

namespace depth_fusion {

// Each adds its subcommand, which runs as it is parsed.
void addResolutionBenchmark(CLI::App& app, ResolutionOptions& options);
void addRenderersBenchmark(CLI::App& app, ResolutionOptions& options);

}  // namespace depth_fusion
