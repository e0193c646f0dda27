// benchmark suite: the whole pipeline over a recording.
#pragma once

#include "apps/benchmark/tracking_inputs.h"

namespace depth_fusion {

// Registers pipeline_overlapped/INPUT, each frame with the next one prepared beside it as `reconstruct` does:
// its time is the median of the frames' times, without reading and decoding; its counters are their 95th
// percentile, the medians of the stages, and how many frames were lost.
void registerPipelineBenchmark(ComputeContext& compute, const TrackingInput& input);

}  // namespace depth_fusion
