// How many blocks each row of a plan needs for a recording or a mesh.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "depth_fusion/evaluation/resolution_plan.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

struct CountingOptions {
  std::string input;            // a recording, or a PLY mesh
  std::string trajectory_file;  // empty: the poses are tracked, as reconstruct does
  std::string device;
  size_t max_frames = 0;  // 0 = all
  RecordingOptions recording;
  PipelineParameters parameters;
};

// Sets the blocks of each row whose offsets alone are within the limit, and says on standard output what it
// does. Throws Error if there is nothing to count.
void countBlocks(const CountingOptions& options, ResolutionPlan& plan);

}  // namespace depth_fusion
