#include "depth_fusion/pipeline/mapper.h"

#include <algorithm>

#include "depth_fusion/preprocessing/depth_range.h"

namespace depth_fusion {
namespace {

constexpr double kBeyond = 1.1;  // how far the next view may reach, to what was measured last

double farthest_m(const DepthFrame& depth) {
  const std::vector<float> tiles = depth.max_tiles.read<float>(depth.max_tiles.bytes() / sizeof(float));
  return tiles.empty() ? 0.0 : static_cast<double>(*std::max_element(tiles.begin(), tiles.end()));
}

}  // namespace

Mapper::Mapper(ComputeContext& compute, BlockMap& map, SubmapCollection& submaps,
               const PipelineParameters& parameters, const CameraIntrinsics& camera)
    : parameters_(parameters),
      map_(map),
      submaps_(submaps),
      camera_(camera),
      view_range_m_(parameters_.depthRange().max_m),
      fusion_(compute, map, parameters.tsdf_fusion),
      color_fusion_(ColorFusion::create(compute, map, parameters.color_fusion)),
      renderer_(compute, map, camera, parameters.model_view) {}

void Mapper::setParameters(const PipelineParameters& parameters) {
  fusion_.setParameters(parameters.tsdf_fusion);
  if (color_fusion_) color_fusion_->setParameters(parameters.color_fusion);
  parameters_ = parameters;
}

MappingResult Mapper::fuse(const RgbdFrame& frame, const DepthFrame& depth, const Pose& T_W_D, bool is_given,
                           StageTimers& timers) {
  MappingResult result;
  if (submaps_.isEmpty()) map_.placeWindow(windowCentre(frame, parameters_.depthRange(), T_W_D));
  submaps_.enter(T_W_D, is_given);
  view_range_m_ = kBeyond * farthest_m(depth) + 2.0 * static_cast<double>(map_.parameters().truncation_m);
  show(T_W_D, timers);
  result.fusion = fusion_.integrate(depth, T_W_D, timers);
  if (color_fusion_) {
    result.color = color_fusion_->integrate(frame, depth, T_W_D, fusion_.visibleBlocks(),
                                            result.fusion.blocks_updated, timers);
  }
  if (map_.isFollowed()) map_.noteUpdated(fusion_.visibleBlocks().read<int>(result.fusion.blocks_updated));
  return result;
}

const ModelView& Mapper::render(const Pose& T_W_D, StageTimers& timers) {
  show(T_W_D, timers);
  const DepthRange range = parameters_.depthRange();
  return renderer_.render(T_W_D, range.min_m, range.max_m, timers);
}

void Mapper::show(const Pose& T_W_D, StageTimers& timers) {
  const StageTimers::Scope timer(timers, "submaps/show");
  submaps_.show(camera_, T_W_D, view_range_m_);
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
