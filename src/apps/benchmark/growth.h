// benchmark growth: frame time against frames mapped, blocks allocated, image size and voxel size.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace depth_fusion {

struct GrowthOptions {
  std::string output = "docs";
  std::string device;
  size_t frames = 10000;
  size_t views = 250;  // of a room
  size_t rooms = 18;
  std::vector<int> widths = {320, 640, 960, 1280};
  std::vector<double> voxels_mm = {20.0, 10.0, 5.0, 2.5};
  size_t few_views = 30;  // of the curves over image and voxel size
};

// Adds the subcommand, which runs as it is parsed.
void addGrowthBenchmark(CLI::App& app, GrowthOptions& options);

}  // namespace depth_fusion
