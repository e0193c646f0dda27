// benchmark tracking --noise: a rendered office and a large room with the noise of sensors, without texture.
#pragma once

#include "apps/benchmark/tracking.h"

namespace depth_fusion {

// Prints a table of what is lost, how far poses and surface are off, and how long a frame takes beside one
// without noise; writes noise.md.
void runNoise(const TrackingBenchmark& options);

}  // namespace depth_fusion
