// A stored map's layers, row by row, past rows that are damaged.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "depth_fusion/store/database.h"
#include "depth_fusion/submaps/map_description.h"
#include "submaps/block_rows.h"

namespace depth_fusion {

// Calls with the rows whose keys begin with the prefix.
using RowSource = std::function<void(const std::string& prefix, const DatabaseReader::Visit& visit)>;

// The blocks of each group.
using GroupBlocks = std::map<BlockIndex, std::vector<BlockIndex>, BlockOrder>;

// The layers that the map has, the TSDF first. Throws Error for one that this program does not know.
std::vector<LayerRow> storedLayers(const MapDescription& description);
int blockSizeOf(const MapDescription& description);

// Calls with each row of a submap's layer that can be read; of the others it notes what is wrong.
void forEachGroup(const RowSource& rows, uint32_t submap, const LayerRow& layer, int block_size,
                  std::vector<std::string>& problems,
                  const std::function<void(const std::string& key, const std::string& row,
                                           const BlockIndex& index, BlockGroup group)>& visit);

}  // namespace depth_fusion
