// benchmark measures how fast everything is, and repeats the experiments behind docs/; each is a subcommand,
// in benchmark/.
#include "apps/benchmark/covariance.h"
#include "apps/benchmark/filters.h"
#include "apps/benchmark/growth.h"
#include "apps/benchmark/long_walk.h"
#include "apps/benchmark/loops.h"
#include "apps/benchmark/resolution.h"
#include "apps/benchmark/suite.h"
#include "apps/benchmark/tracking.h"
#include "apps/command_line.h"

int main(int argc, char** argv) {
  CLI::App app("Measures how fast everything is, or runs an experiment and writes its tables and pictures.",
               "benchmark");
  app.require_subcommand(0, 1);
  depth_fusion::addFiltersBenchmark(app);
  depth_fusion::TrackingBenchmark tracking;
  depth_fusion::addTrackingBenchmark(app, tracking);
  depth_fusion::ResolutionOptions resolution, renderers;
  depth_fusion::addResolutionBenchmark(app, resolution);
  depth_fusion::addRenderersBenchmark(app, renderers);
  depth_fusion::GrowthOptions growth;
  depth_fusion::addGrowthBenchmark(app, growth);
  depth_fusion::LongWalkOptions long_walk;
  depth_fusion::addLongWalkBenchmark(app, long_walk);
  depth_fusion::LoopsOptions loops;
  depth_fusion::addLoopsBenchmark(app, loops);
  depth_fusion::CovarianceOptions covariance;
  depth_fusion::addCovarianceBenchmark(app, covariance);
  depth_fusion::TrackingBenchmark suite;
  depth_fusion::addBenchmarkSuite(app, suite);
  return depth_fusion::runApp(app, [&] {
    app.parse(argc, argv);
    return 0;
  });
}
