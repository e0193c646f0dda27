// Block selection: which blocks a frame's measurements need that the map does not have.
#pragma once

#include <functional>
#include <vector>

#include "tsdf_fusion/tsdf_fusion_kernels.h"

namespace depth_fusion {

class BlockSelection {
 public:
  // Keeps the reference to the kernels.
  BlockSelection(ComputeContext& compute, TsdfFusion::Kernels& kernels);

  // Claims the blocks in the map's offsets and lists them, sorted, one bounded list after the other as long
  // as lists are full and take(list) returns true. Returns how many samples of the surface are outside of the
  // map's window.
  size_t select(const DepthFrame& frame, BlockMap& map, const Pose& T_W_D,
                const std::function<bool(const std::vector<BlockIndex>&)>& take);

 private:
  TsdfFusion::Kernels& kernels_;
  DeviceBuffer requests_, count_, points_outside_;
};

}  // namespace depth_fusion
