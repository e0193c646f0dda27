// The frames of a recording once more, at poses that are better known by then.
#pragma once

#include <atomic>

#include "apps/reconstruct/run_log.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

// Fuses the frames that the log's trajectory has, where it has them, into the parts of the map that the
// keyframes have. What cannot be read was said in the first pass.
void fuseAgain(Recording& recording, const Corrections& keyframes, ReconstructionPipeline& pipeline,
               RunLog& log, const std::atomic<bool>& interrupted);

}  // namespace depth_fusion
