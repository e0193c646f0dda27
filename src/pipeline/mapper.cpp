#include "depth_fusion/pipeline/mapper.h"

#include "depth_fusion/preprocessing/depth_range.h"

namespace depth_fusion {

Mapper::Mapper(ComputeContext& compute, BlockMap& map, const PipelineParameters& parameters,
               const CameraIntrinsics& camera)
    : parameters_(parameters),
      map_(map),
      fusion_(compute, map, parameters.tsdf_fusion),
      color_fusion_(ColorFusion::create(compute, map, parameters.color_fusion)),
      renderer_(compute, map, camera, parameters.model_view) {}

void Mapper::setParameters(const PipelineParameters& parameters) {
  fusion_.setParameters(parameters.tsdf_fusion);
  if (color_fusion_) color_fusion_->setParameters(parameters.color_fusion);
  parameters_ = parameters;
}

MappingResult Mapper::fuse(const RgbdFrame& frame, const DepthFrame& depth, const Pose& T_W_D,
                           StageTimers& timers) {
  MappingResult result;
  if (map_.slots().used() == 0) map_.placeWindow(windowCentre(frame, parameters_.depthRange(), T_W_D));
  result.fusion = fusion_.integrate(depth, T_W_D, timers);
  if (color_fusion_) {
    result.color = color_fusion_->integrate(frame, depth, T_W_D, fusion_.visibleBlocks(),
                                            result.fusion.blocks_updated, timers);
  }
  if (map_.isFollowed()) map_.noteUpdated(fusion_.visibleBlocks().read<int>(result.fusion.blocks_updated));
  return result;
}

const ModelView& Mapper::render(const Pose& T_W_D, StageTimers& timers) {
  const DepthRange range = parameters_.depthRange();
  return renderer_.render(T_W_D, range.min_m, range.max_m, timers);
}

std::string leftOutReason(const MappingResult& result) {
  if (result.fusion.blocks_allocated < result.fusion.blocks_requested)
    return "the pool is full: new surface is left out; raise map/pool_mib or map/voxel_size_m";
  if (result.fusion.points_outside > 0)
    return "surface outside of the map's window is left out; raise map/blocks_per_axis";
  return "";
}

std::string notFusedReason() {
  return "no depth in range and in the map's window; see map/blocks_per_axis and preprocessing/max_range_m";
}

}  // namespace depth_fusion
