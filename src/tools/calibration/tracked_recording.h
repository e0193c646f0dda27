// A recording, tracked: what calibration needs of it.
#pragma once

#include <functional>

#include "depth_fusion/recording/recording.h"
#include "tools/calibration/time_offset.h"

namespace depth_fusion {

struct TrackedRecording {
  Trajectory trajectory;                      // of the frames that are not lost
  std::vector<CalibrationFrame> frames;       // some of these, a step apart each
  std::vector<MeasuredMotion> color_motions;  // between colour images, by their stamps
  std::string color_problem;                  // why the last frame has no motion
  size_t read = 0;
  double explained = 0.0;  // how much of a frame the map explains (TrackingResult), in the mean
};

struct TrackingRange {
  size_t first = 0;  // frames before are left out
  size_t count = 0;  // 0: all
};

using Say = std::function<void(const std::string&)>;

// Says how far it is, and which frame could not be read. Throws Error if fewer than half of the frames can be
// tracked.
TrackedRecording track(ComputeContext& compute, Recording& recording, const PipelineParameters& parameters,
                       const TrackingRange& range, const Say& say);

// Returns the motions from each pose to the next.
std::vector<MeasuredMotion> motionsOf(const Trajectory& trajectory);

}  // namespace depth_fusion
