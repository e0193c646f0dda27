#include "map/map_kernels.h"

#include "map/map_args.h"

namespace depth_fusion {

MapKernels::MapKernels(ComputeContext& compute, const MapParameters& map)
    : items_per_block_(map.block_size * map.block_size * map.block_size / 16),
      assign_(compute, "map/blocks.cl", "assign_blocks", blockSizeOption(map)),
      withdraw_(compute, "map/blocks.cl", "withdraw_requests", blockSizeOption(map)),
      remove_(compute, "map/blocks.cl", "remove_blocks", blockSizeOption(map)),
      gather_(compute, "map/blocks.cl", "gather_slots", blockSizeOption(map)),
      scatter_(compute, "map/blocks.cl", "scatter_slots", blockSizeOption(map)),
      clear_(compute, "map/blocks.cl", "clear_blocks", blockSizeOption(map)) {}

void MapKernels::assignBlocks(BlockMap& map, const DeviceBuffer& blocks, const DeviceBuffer& slots,
                              int count) {
  assign_.run(static_cast<size_t>(count), map.offsets(), map.blockIndices(), map.blockStates(), blocks, slots,
              count, gridArgs(map));
}

void MapKernels::withdrawRequests(BlockMap& map, const DeviceBuffer& blocks, int count) {
  withdraw_.run(static_cast<size_t>(count), map.offsets(), blocks, count, gridArgs(map));
}

void MapKernels::removeBlocks(BlockMap& map, const DeviceBuffer& slots, int count) {
  remove_.run(static_cast<size_t>(count), map.offsets(), map.blockIndices(), slots, count, gridArgs(map));
}

void MapKernels::gatherSlots(const BlockLayer& layer, DeviceBuffer& blocks, const DeviceBuffer& slots,
                             int count) {
  gather_.run(items(count), layer.buffer(), blocks, static_cast<int>(layer.bytesPerVoxel()), slots, count);
}

void MapKernels::scatterSlots(BlockLayer& layer, const DeviceBuffer& blocks, const DeviceBuffer& slots,
                              int count) {
  scatter_.run(items(count), layer.buffer(), blocks, static_cast<int>(layer.bytesPerVoxel()), slots, count);
}

void MapKernels::clearBlocks(BlockLayer& layer, const DeviceBuffer& slots, int count) {
  clear_.run(items(count), layer.buffer(), layer.clearedBlock(), static_cast<int>(layer.bytesPerVoxel()),
             slots, count);
}

}  // namespace depth_fusion
