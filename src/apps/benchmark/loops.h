// benchmark loops: how many of the places that are seen again are found, how many loops are false, and what
// they do to drift.
#pragma once

#include <string>
#include <vector>

#include "apps/command_line.h"
#include "depth_fusion/loops/loop_parameters.h"

namespace depth_fusion {

struct LoopsOptions {
  std::string output = "loops";
  std::string data;
  std::vector<std::string> inputs;
  int seeds = 3;
  float drift = 1.0f;
  std::vector<std::string> parameter_files;
  LoopParameters parameters;
};

void addLoopsBenchmark(CLI::App& app, LoopsOptions& options);

}  // namespace depth_fusion
