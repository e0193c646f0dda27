// report.json: what a run did and how long it took.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"

namespace depth_fusion {

// Describes frames in a row that were lost.
struct Loss {
  size_t first_frame = 0;  // counted from 1
  size_t frames = 0;
  std::string reason;  // of the first
};

struct RunCounts {
  size_t read = 0;
  size_t tracked = 0;
  size_t degenerate = 0;  // of the tracked, those whose pose is the prior's in some direction
  size_t lost = 0;
  size_t unreadable = 0;
  size_t colored = 0;  // of the tracked ones: with colour in the map
  std::vector<Loss> losses;
  size_t loops = 0;               // closed
  double moved_by_loops_m = 0.0;  // the pose that they moved most
  std::string map_doubt;          // TrackingResult::map_doubt, if there was one
};

// Returns the largest resident set of the process so far, in bytes.
size_t peakRssBytes();

// Throws Error if the file cannot be written completely.
void writeReport(const std::string& path, const std::string& input, ComputeContext& compute,
                 ReconstructionPipeline& pipeline, const RunCounts& counts, size_t tracking_peak_rss_bytes);

}  // namespace depth_fusion
