// TSDF fusion: block selection and integration of one depth frame at a known pose.
#pragma once

#include <memory>

#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/frames/depth_frame.h"
#include "depth_fusion/frames/mapping_result.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/map/block_map.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion_parameters.h"

namespace depth_fusion {

class BlockSelection;

class TsdfFusion {
 public:
  class Kernels;  // typed launches, private to the library and its tests

  TsdfFusion(ComputeContext& compute, BlockMap& map, const TsdfFusionParameters& parameters);
  ~TsdfFusion();

  // The parameters are for the frames to come. Throws Error if rule or distance are others than before.
  void setParameters(const TsdfFusionParameters& parameters);

  // Fuses the frame's measurements, seen from T_W_D, into the map; allocates the blocks it needs and releases
  // those left empty.
  FusionResult integrate(const DepthFrame& frame, const Pose& T_W_D, StageTimers& timers);

  // Slots of the blocks that the last frame updated, FusionResult::blocks_updated of them.
  const DeviceBuffer& visibleBlocks() const { return visible_; }

 private:
  void allocateBlocks(const DepthFrame& frame, const Pose& T_W_D, FusionResult& result);

  ComputeContext& compute_;
  BlockMap& map_;
  TsdfFusionParameters parameters_;
  DeviceBuffer visible_, empty_, count_;
  std::unique_ptr<Kernels> kernels_;
  std::unique_ptr<BlockSelection> selection_;
  int frame_number_ = 0;
};

}  // namespace depth_fusion
