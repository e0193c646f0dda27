// Whole runs on a simulated recording, in memory.
#pragma once

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "tools/evaluation/mesh_error.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {

enum class Poses { kGiven, kTracked };

struct Reconstruction {
  Trajectory estimate, truth;  // of the frames that are not lost
  size_t lost = 0;
  BlockMap::Usage usage;
  TriangleMesh mesh;
  Pose T_W_M = Pose::Identity();  // maps the mesh into the scene's world
};

inline Reconstruction reconstruct(ComputeContext& compute, SimulatedRecording& recording,
                                  const PipelineParameters& parameters, Poses poses) {
  Reconstruction result;
  if (poses == Poses::kTracked) result.T_W_M = recording.poseOf(0).T_W_D;
  std::unique_ptr<ReconstructionPipeline> pipeline;
  while (const std::optional<RgbdFrame> frame = recording.next()) {
    if (!pipeline)
      pipeline = std::make_unique<ReconstructionPipeline>(compute, parameters, frame->intrinsics);
    const TrackingResult tracking = poses == Poses::kGiven
                                        ? pipeline->processFrame(*frame, *frame->T_W_D).tracking
                                        : pipeline->processFrame(*frame).tracking;
    if (tracking.status == TrackingStatus::kLost) {
      ++result.lost;
      continue;
    }
    result.estimate.push_back({frame->stamp_s, tracking.T_W_D});
    result.truth.push_back({frame->stamp_s, *frame->T_W_D});
  }
  result.usage = pipeline->map().usage();
  exportSurfaceMesh(compute, pipeline->map(), result.mesh, parameters.surface_mesh);
  return result;
}

}  // namespace depth_fusion
