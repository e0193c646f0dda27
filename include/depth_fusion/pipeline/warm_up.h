// Readies the device before the first frame comes.
#pragma once

#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"

namespace depth_fusion {

// Builds every kernel of the pipeline and runs it once, on a made-up wall and a small map: what devices put
// off until a kernel's first launch is then done, and takes no time of the first frames.
void warmUp(ComputeContext& compute, PipelineParameters parameters);

}  // namespace depth_fusion
