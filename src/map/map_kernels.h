// Typed launches of kernels/map/*.cl.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/map/block_map.h"

namespace depth_fusion {

class MapKernels {
 public:
  MapKernels(ComputeContext& compute, const MapParameters& map);

  // Enters the first `count` of the blocks with their slots.
  void assignBlocks(BlockMap& map, const DeviceBuffer& blocks, const DeviceBuffer& slots, int count);
  // Takes back the claims of the first `count` of the blocks.
  void withdrawRequests(BlockMap& map, const DeviceBuffer& blocks, int count);
  // Makes the first `count` of the slots blocks of which nothing is known.
  void clearBlocks(BlockLayer& layer, const DeviceBuffer& slots, int count);

 private:
  int clearing_items_per_block_;
  Kernel assign_, withdraw_, clear_;
};

}  // namespace depth_fusion
