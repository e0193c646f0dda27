// benchmark tracking: what texture odometry, the eigenvalue analysis and each of the gates do for tracking
// (the paper's registration figure).
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace depth_fusion {

struct TrackingBenchmark {
  std::string output = "benchmark_tracking";
  std::string data;  // folder of the real recordings; those that are not there are left out
  std::string cfg = "cfg";
  std::string device;
  std::vector<std::string> inputs;  // all if empty
  bool gates = false;
  size_t starts = 0;
  unsigned seed = 1;     // of the starts
  bool noise = false;    // of sensors, in place of the table
  bool strides = false;  // every start of a list, in place of random ones
};

// Adds the subcommand, which runs as it is parsed.
void addTrackingBenchmark(CLI::App& app, TrackingBenchmark& options);

}  // namespace depth_fusion
