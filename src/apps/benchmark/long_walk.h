// benchmark long_walk: a way through a simulated building at given poses, in memory that does not grow.
#pragma once

#include <string>

#include "apps/command_line.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"

namespace depth_fusion {

struct LongWalkOptions {
  std::string output = "long_walk";
  std::string device;
  std::string scene = "corridor";
  std::string walk;
  int frames = 1000;
  double fps = 6.0;
  int width = 320;
  bool no_mesh = false;
  PipelineParameters parameters;
};

void addLongWalkBenchmark(CLI::App& app, LongWalkOptions& options);

}  // namespace depth_fusion
