// benchmark: the experiments behind docs/, one subcommand each.
#include <CLI/CLI.hpp>
#include <iostream>

#include "apps/benchmark/tracking.h"

namespace depth_fusion {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Runs an experiment and writes its tables and pictures.");
  app.require_subcommand(1);
  TrackingBenchmark tracking;
  addTrackingBenchmark(app, tracking);
  CLI11_PARSE(app, argc, argv);
  return 0;
}

}  // namespace
}  // namespace depth_fusion

int main(int argc, char** argv) {
  try {
    return depth_fusion::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "benchmark: " << error.what() << std::endl;
    return 1;
  }
}
