// From frames with poses to the map, and from the map to model views: TSDF fusion, colour fusion, ray
// casting.
#pragma once

#include <memory>

#include "depth_fusion/color_fusion/color_fusion.h"
#include "depth_fusion/frames/mapping_result.h"
#include "depth_fusion/model_view/model_view_renderer.h"
#include "depth_fusion/pipeline/pipeline_parameters.h"
#include "depth_fusion/submaps/submap_collection.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"

namespace depth_fusion {

class Mapper {
 public:
  // Keeps references; `submaps` are of the map.
  Mapper(ComputeContext& compute, BlockMap& map, SubmapCollection& submaps,
         const PipelineParameters& parameters, const CameraIntrinsics& camera);

  // The parameters are for the frames to come; the map's stay. Throws Error for what cannot change.
  void setParameters(const PipelineParameters& parameters);
  // Fuses `depth`, which is `frame` preprocessed, and notes the changes if somebody follows the map. The
  // window of an empty map is first moved to where the frame looks. `is_given`: the pose is sure, for it is
  // from elsewhere.
  MappingResult fuse(const RgbdFrame& frame, const DepthFrame& depth, const Pose& T_W_D, bool is_given,
                     StageTimers& timers);

  // The map as the camera sees it from T_W_D; valid until the next call.
  const ModelView& render(const Pose& T_W_D, StageTimers& timers);
  ModelViewRenderer& renderer() { return renderer_; }

 private:
  PipelineParameters parameters_;
  BlockMap& map_;
  SubmapCollection& submaps_;
  CameraIntrinsics camera_;
  double view_range_m_;  // up to which the map is wanted
  // Has the map hold what can be seen from there.
  void show(const Pose& T_W_D, StageTimers& timers);

  TsdfFusion fusion_;
  std::unique_ptr<ColorFusion> color_fusion_;  // null for a map without colour
  ModelViewRenderer renderer_;
};

// Why some of a frame was not fused; empty if all of it was.
std::string leftOutReason(const MappingResult& result);
// Why a frame with a pose was not fused.
std::string notFusedReason();

}  // namespace depth_fusion
