// The files that a run leaves behind.
#pragma once

#include "apps/reconstruct/run_log.h"
#include "depth_fusion/submaps/map_file.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"

namespace depth_fusion {

// Writes mesh.ply. Throws Error if it cannot be written.
MeshStatistics writeMesh(const RunOptions& options, ComputeContext& compute,
                         ReconstructionPipeline& pipeline);

// Writes trajectory and report, and the mesh, the map and the page where they are wanted. All are tried; of
// what fails, the log complains. Null for `saver`: the map is saved nowhere.
void writeResults(const RunOptions& options, ComputeContext& compute, ReconstructionPipeline& pipeline,
                  MapSaver* saver, RunLog& log);

}  // namespace depth_fusion
