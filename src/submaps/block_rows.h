// The rows of a map's blocks: neighbouring blocks travel together.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/map/block_index.h"
#include "depth_fusion/map/block_layer.h"
#include "depth_fusion/map/slot_table.h"

namespace depth_fusion {

// A group is a cube of blocks, of some 32 voxels to each axis; groups are counted as blocks are.
int groupEdge(int block_size);
BlockIndex groupOf(const BlockIndex& block, int group_edge);
// The groups that a box of blocks meets, and those about it: a mesh's cells reach two blocks ahead, its
// normals one back.
BlockBox groupsAbout(const BlockBox& box, int group_edge);

// Blocks of a group in a layer.
struct BlockGroup {
  std::vector<BlockIndex> blocks;  // sorted by z, y, x
  std::vector<int> states;         // bits of BLOCK_HAS_DATA and BLOCK_NEAR_SURFACE
  std::string voxels;              // block by block, as in the layer's slots
};

// Blocks of which the layer knows nothing.
BlockGroup clearedGroup(const std::vector<BlockIndex>& blocks, const LayerRow& layer, int block_size);

// A packed row.
std::string blocksRow(const BlockGroup& group, const BlockIndex& index, const LayerRow& layer,
                      int block_size);
// Throws Error, naming `where`, for a damaged row.
BlockGroup parseBlocks(const std::string& row, const BlockIndex& index, const LayerRow& layer, int block_size,
                       const std::string& where);

}  // namespace depth_fusion
