// Groups of blocks out of a map's pool, and parts of groups.
#pragma once

#include <map>
#include <vector>

#include "depth_fusion/map/block_map.h"
#include "submaps/block_rows.h"

namespace depth_fusion {

// A group in each layer, with the same blocks.
using BlockGroups = std::vector<BlockGroup>;

// The blocks in these slots, by their groups.
std::map<BlockIndex, BlockGroups, BlockOrder> groupsIn(BlockMap& map, const std::vector<LayerRow>& layers,
                                                       std::vector<int> slots);

// Two parts of a group as one; of a block that is in both, the first part's counts.
BlockGroups joined(const BlockGroups& a, const BlockGroups& b);

// The blocks that are inside of the window, or those that are not.
BlockGroups partOf(const BlockGroups& group, const Window& window, bool inside);

}  // namespace depth_fusion
