// benchmark: the experiments behind docs/, a subcommand each, in benchmark/.
#include <CLI/CLI.hpp>
#include <iostream>

#include "apps/benchmark/filters.h"
#include "apps/benchmark/resolution.h"
#include "apps/benchmark/tracking.h"

int main(int argc, char** argv) {
  CLI::App app("Runs an experiment and writes its tables and pictures.");
  app.require_subcommand(1);
  depth_fusion::addFiltersBenchmark(app);
  depth_fusion::TrackingBenchmark tracking;
  depth_fusion::addTrackingBenchmark(app, tracking);
  depth_fusion::ResolutionOptions resolution, renderers;
  depth_fusion::addResolutionBenchmark(app, resolution);
  depth_fusion::addRenderersBenchmark(app, renderers);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    std::cerr << "benchmark: " << error.what() << std::endl;
    return 1;
  }
  return 0;
}
