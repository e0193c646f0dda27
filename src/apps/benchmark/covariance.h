// benchmark covariance: whether poses and velocities are as far off as their covariances say.
#pragma once

#include <string>
#include <vector>

#include "apps/command_line.h"

namespace depth_fusion {

struct CovarianceOptions {
  std::string output = "covariance";
  std::string cfg = "cfg";  // folder of the sensors' parameter files
  std::string data;         // folder of the real recordings
  std::string device;
  std::vector<std::string> inputs;  // all if empty
  int runs = 20;
  int frames = 60;
  int width = 320;
};

// Adds the subcommand, which runs as it is parsed.
void addCovarianceBenchmark(CLI::App& app, CovarianceOptions& options);

}  // namespace depth_fusion
