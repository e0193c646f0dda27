// How many blocks each row of a plan needs for a recording or a mesh.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/recording/recording.h"
#include "tools/evaluation/resolution_plan.h"

namespace depth_fusion {

struct CountingOptions {
  std::vector<std::string> inputs;  // a recording, bags that are the parts of one, or a PLY mesh
  std::string trajectory_file;      // empty: the poses are tracked, as reconstruct does
  std::string device;
  size_t max_frames = 0;  // 0 = all
  RecordingOptions recording;
  PipelineParameters parameters;
};

// Says on standard output what it does.
class BlockCounting {
 public:
  // Throws Error if the input cannot be read.
  explicit BlockCounting(const CountingOptions& options);
  ~BlockCounting();

  // Sets the blocks of each row whose offsets alone are within the limit. Throws Error if there is nothing to
  // count.
  void count(ResolutionPlan& plan);
  // Fuses the recording with the row's map, and sets the blocks that are then in use: block selection does
  // not know what noise fusion carves away again. Does nothing for a mesh.
  void tryOut(PlanRow& row);

 private:
  struct Surface;
  struct Mesh;
  struct Frames;

  std::unique_ptr<Surface> surface_;
};

}  // namespace depth_fusion
