// benchmark without a subcommand: google-benchmark over every kernel, every stage and the whole pipeline.
#pragma once

#include "apps/benchmark/tracking.h"

namespace depth_fusion {

// Adds what the app does without a subcommand, which takes google-benchmark's own options, too. It is called
// when all subcommands are there.
void addBenchmarkSuite(CLI::App& app, TrackingBenchmark& options);

}  // namespace depth_fusion
