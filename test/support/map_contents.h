// What a map holds, on the host.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "depth_fusion/map/block_map.h"

namespace depth_fusion {

using BlockKey = std::array<int, 3>;  // z, y, x

inline BlockKey keyOf(const BlockIndex& block) { return {block.z(), block.y(), block.x()}; }
inline BlockIndex indexOf(const BlockKey& key) { return {key[2], key[1], key[0]}; }

// Holds the distances and certainties of the M^3 voxels of a block.
struct BlockContent {
  std::vector<int8_t> distances;
  std::vector<uint8_t> certainties;
  bool operator==(const BlockContent& other) const {
    return distances == other.distances && certainties == other.certainties;
  }
};

using MapContent = std::map<BlockKey, BlockContent>;

inline MapContent readMap(BlockMap& map) {
  const size_t m = map.parameters().block_size;
  const size_t voxels = m * m * m;
  const std::vector<uint8_t> bytes = map.layer(kTsdfLayer).read<uint8_t>(2 * voxels * map.slots().bound());
  MapContent content;
  for (const SlotTable::Block& block : map.slots().blocks()) {
    const auto begin = bytes.begin() + 2 * voxels * block.slot;
    content[keyOf(block.index)] = {{begin, begin + voxels}, {begin + voxels, begin + 2 * voxels}};
  }
  return content;
}

}  // namespace depth_fusion
