// report.html: what a run did, for people.
#pragma once

#include "apps/reconstruct/run_log.h"

namespace depth_fusion {

// Writes the page beside the results, of which it reads the mesh. A recording's folder that has true poses,
// or says which built-in scene it shows, is what errors are measured against. Throws Error if the page cannot
// be written.
void writePage(const RunOptions& options, ComputeContext& compute, ReconstructionPipeline& pipeline,
               const RunLog& log);

}  // namespace depth_fusion
