// A recording calibrates the depth sensor that it was taken with.
#pragma once

#include "tools/calibration/tracked_recording.h"

namespace depth_fusion {

struct SelfCalibration {
  DepthCalibration depth;
  PipelineParameters corrected;  // the given parameters, with what was found applied
  TrackedRecording tracked;      // with the corrected parameters
  size_t frames_used = 0;
  double explained_before = 0.0;  // TrackedRecording::explained under the given parameters
  bool refused = false;           // the map explained the frames less well afterwards, so nothing is applied
};

using OpenRecording = std::function<std::unique_ptr<Recording>()>;

// Tracks the recording, calibrates from it, and tracks it again with what was found, if anything is applied.
// Depth offsets among the given parameters do not count. Throws Error, which says why, if the recording
// cannot tell.
SelfCalibration calibrateFrom(ComputeContext& compute, const OpenRecording& open,
                              const PipelineParameters& parameters, const TrackingRange& range,
                              const Say& say);

// Says what was found of the depth, how sure that is, and what of it is applied, line by line.
std::string calibrationText(const SelfCalibration& calibration);

}  // namespace depth_fusion
