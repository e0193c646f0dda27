// report.json: what a run did and how long it took.
#pragma once

#include <string>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"

namespace depth_fusion {

struct RunCounts {
  size_t read = 0;
  size_t tracked = 0;
  size_t lost = 0;
  size_t unreadable = 0;
  size_t colored = 0;  // of the tracked ones: with colour in the map
};

// Largest resident set of the process so far.
size_t peakRssBytes();

// Throws Error if the file cannot be written completely.
void writeReport(const std::string& path, const std::string& input, ComputeContext& compute,
                 ReconstructionPipeline& pipeline, const RunCounts& counts, size_t tracking_peak_rss_bytes);

}  // namespace depth_fusion
