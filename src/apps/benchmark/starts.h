// benchmark tracking --starts: tracking begun at random frames of the inputs, at random frame rates, with and
// without texture. It looks for frames that are called tracked and are wrong.
#pragma once

#include "apps/benchmark/tracking_inputs.h"

namespace depth_fusion {

// The inputs that starts are drawn of: those that options.inputs names, or all.
std::vector<TrackingInput> startInputs(const TrackingBenchmark& options);

// Runs options.starts starts and prints a table of the inputs and a line for each start that went wrong;
// writes starts.md, and starts.csv with every frame.
void runStarts(const TrackingBenchmark& options);

}  // namespace depth_fusion
