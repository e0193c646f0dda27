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
  // Takes the blocks of the first `count` of the slots out of the map.
  void removeBlocks(BlockMap& map, const DeviceBuffer& slots, int count);
  // Copy the blocks of the first `count` of the slots to a list of blocks, and back.
  void gatherSlots(const BlockLayer& layer, DeviceBuffer& blocks, const DeviceBuffer& slots, int count);
  void scatterSlots(BlockLayer& layer, const DeviceBuffer& blocks, const DeviceBuffer& slots, int count);
  // Makes the first `count` of the slots blocks of which nothing is known.
  void clearBlocks(BlockLayer& layer, const DeviceBuffer& slots, int count);

 private:
  size_t items(int blocks) const {
    return static_cast<size_t>(blocks) * static_cast<size_t>(items_per_block_);
  }

  int items_per_block_;  // of those that copy blocks
  Kernel assign_, withdraw_, remove_, gather_, scatter_, clear_;
};

}  // namespace depth_fusion
