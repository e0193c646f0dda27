// Two stored maps, of two sessions or two robots, made one by what both have seen.
#pragma once

#include <functional>

#include "depth_fusion/compute/compute_context.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/store/database.h"
#include "depth_fusion/submaps/map_file.h"

namespace depth_fusion {

// How a map lies to another one.
struct MapOverlap {
  Pose T_A_B = Pose::Identity();  // of the second map's world in the first one's
  size_t agreeing = 0;            // keyframes of the second map that say so,
  size_t fitting = 0;             // of so many that fit somewhere
  double spread_m = 0.0;          // rms by which those that agree are off from it, at their places
};

struct MergedMaps {
  MapOverlap overlap;
  SaveReport saved;
};

// Finds how the second map lies to the first: keyframes that look alike are compared by the maps as they see
// them, as loops are (LoopVerifier), and aligned with the first map by ICP; those that agree on one motion
// give it. Then the second map is fused into the first one as its keyframes see it, and the result is saved;
// the first map's voxels stay its own where the second does not reach. `progress` is called with the share
// that is done. Throws Error, and saves nothing, if too few keyframes agree, if others say something else, or
// if a map is damaged or cannot be saved.
MergedMaps mergeMaps(ComputeContext& compute, const PipelineParameters& parameters, Database& first,
                     Database& second, MapSaver& saver, const std::function<void(double)>& progress = {});

}  // namespace depth_fusion
