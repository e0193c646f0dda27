// Typed launches of kernels/tsdf_fusion/*.cl. Lists come back in any order: sort what must be repeatable.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"
#include "map/slots_in_view.h"
#include "shared/types.h"

namespace depth_fusion {

// The code of a variance in a voxel's second byte, 0 for one above the scale.
int certaintyOf(float variance);

FusionArgs fusionArgs(const TsdfFusionParameters& parameters, const MapParameters& map,
                      const DepthFrame& frame, int frame_number);

class TsdfFusion::Kernels {
 public:
  Kernels(ComputeContext& compute, const BlockMap& map, const TsdfFusionParameters& parameters = {});

  void requestBlocks(const DepthFrame& frame, BlockMap& map, DeviceBuffer& requests, DeviceBuffer& count,
                     DeviceBuffer& points_outside, const Pose& T_W_D, const SelectionArgs& args);
  void listVisibleBlocks(const DepthFrame& frame, BlockMap& map, DeviceBuffer& visible, DeviceBuffer& count,
                         const Pose& T_D_W);
  void integrateBlocks(const DepthFrame& frame, BlockMap& map, const DeviceBuffer& visible, int visible_count,
                       const Pose& T_D_W, const FusionArgs& args);
  void listEmptyBlocks(BlockMap& map, const DeviceBuffer& visible, int visible_count, DeviceBuffer& empty,
                       DeviceBuffer& count);

 private:
  SlotsInView in_view_;
  int simd_width_;
  size_t items_per_block_;
  Kernel request_, visible_, integrate_, empty_;
};

}  // namespace depth_fusion
