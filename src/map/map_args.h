// What a kernel needs to know of the map.
#pragma once

#include <string>

#include "depth_fusion/map/block_sparse_map.h"
#include "shared/types.h"

namespace depth_fusion {

GridArgs gridArgs(const BlockSparseMap& map);

// Build options of the programs that include shared/block_map.h.
std::string blockSizeOption(const MapParameters& parameters);

}  // namespace depth_fusion
