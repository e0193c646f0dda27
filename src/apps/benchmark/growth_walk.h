// benchmark growth: a walk through rooms that look alike, so that the map grows while the views stay the
// same.
#pragma once

#include <vector>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"

namespace depth_fusion {

// Renders depth images of consecutive views of the simulated room, in millimetres as sensors give them. They
// have no colour, for what texture takes depends on no map, and keyframes of rooms alike mislead. `width`
// scales the camera of 640x480.
std::vector<RgbdFrame> roomViews(int width, size_t count);

class GrowthWalk {
 public:
  // Keeps references to its arguments. A pool that turns out to be too small for the walk is an Error.
  GrowthWalk(ComputeContext& compute, const PipelineParameters& parameters,
             const std::vector<RgbdFrame>& views);

  // Goes to the first view of the room whose first camera stands at room_W; the start is known. Timers begin
  // anew.
  void enter(const Eigen::Vector3d& room_W);
  // Tracks and fuses one frame of the present room.
  void look(size_t view);
  // They go from the first view to the last, and back.
  void lookForth();
  void lookBack();

  // Forgets times and counts of frames so far, but not what the walk has come to.
  void startTiming();
  const StageTimers& timers() { return pipeline_.timers(); }
  double blocksInView() const {
    return static_cast<double>(updated_blocks_) / static_cast<double>(timed_frames_);
  }

  size_t frames() const { return frames_; }
  size_t lost() const { return lost_; }  // while looking
  size_t blocks() { return pipeline_.map().usage().blocks; }

 private:
  RgbdFrame frameOf(size_t view);

  const std::vector<RgbdFrame>& views_;
  ReconstructionPipeline pipeline_;
  size_t frames_ = 0, lost_ = 0;
  size_t timed_frames_ = 0, updated_blocks_ = 0;  // since startTiming
};

}  // namespace depth_fusion
