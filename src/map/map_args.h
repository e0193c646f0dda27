// What a kernel needs to know of the map.
#pragma once

#include <string>

#include "depth_fusion/map/block_map.h"
#include "shared/types.h"

namespace depth_fusion {

// A block that is asked for, as kernels have it: an int4.
struct BlockRequest {
  int x, y, z, unused;
};

GridArgs gridArgs(const BlockMap& map);

// Work-items a block of the kernels that include shared/block_items.h.
inline size_t itemsPerBlock(const MapParameters& map, int simd_width) {
  return map.block_size * map.block_size * map.block_size / VOXELS_PER_ITEM(simd_width, map.block_size);
}

// Build options of the programs that include shared/block_map.h.
std::string blockSizeOption(const MapParameters& parameters);

}  // namespace depth_fusion
