// The pipeline's side of a stored map.
#pragma once

#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/submaps/map_description.h"

namespace depth_fusion {

// What is stored of a map beside its contents.
MapDescription descriptionOf(PipelineParameters parameters, const CameraIntrinsics& camera,
                             const StampedPose& last_pose);

// Sets what a map that goes on must have as it was made with: its voxels and how they are filtered. Throws
// Error if these parameters are not in range any more.
void adoptParameters(const MapDescription& stored, PipelineParameters& parameters);

// Throws Error if the map's voxels were filtered by another rule than these parameters have, by which their
// bytes mean something else; `name` is the map's.
void checkFilterRule(const MapDescription& stored, PipelineParameters parameters, const std::string& name);

}  // namespace depth_fusion
