// Fills a map, and a dense grid, from a signed distance function.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "depth_fusion/map/block_map.h"
#include "reference/reference_marching_cubes.h"

namespace depth_fusion {

using VoxelWeight = std::function<uint8_t(const Eigen::Vector3i&)>;
using SignedDistance = std::function<double(const Eigen::Vector3d&)>;  // metres, positive in free space

inline int8_t distanceByte(const MapParameters& map, const SignedDistance& distance,
                           const Eigen::Vector3i& voxel) {
  const double fraction = distance(voxel.cast<double>() * map.voxel_size_m) / map.truncation_m;
  return std::abs(fraction) > 1.0 ? int8_t{-128} : static_cast<int8_t>(std::lround(127.0 * fraction));
}

// Allocates the blocks from `first` on, `count` along each axis, that hold a known voxel, all with the given
// weight.
inline void fillMap(
    BlockMap& map, const SignedDistance& distance, const Eigen::Vector3i& first, int count,
    const VoxelWeight& weight = [](const Eigen::Vector3i&) { return uint8_t{1}; }) {
  const int m = map.parameters().block_size;
  const size_t voxels = static_cast<size_t>(m) * m * m;
  std::vector<BlockIndex> indices;
  std::vector<std::vector<uint8_t>> contents;
  for (int block = 0; block < count * count * count; ++block) {
    const Eigen::Vector3i index =
        first + Eigen::Vector3i(block % count, block / count % count, block / count / count);
    std::vector<uint8_t> content(2 * voxels);
    bool known = false;
    for (size_t v = 0; v < voxels; ++v) {
      const int i = static_cast<int>(v);
      const Eigen::Vector3i voxel = m * index + Eigen::Vector3i(i % m, i / m % m, i / m / m);
      const int8_t byte = distanceByte(map.parameters(), distance, voxel);
      content[v] = static_cast<uint8_t>(byte);
      content[voxels + v] = weight(voxel);
      known = known || byte != -128;
    }
    if (!known) continue;
    indices.push_back(index);
    contents.push_back(std::move(content));
  }
  map.allocate(indices);
  for (const SlotTable::Block& block : map.slots().blocks()) {
    for (size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] == block.index)
        map.layer(kTsdfLayer).write(contents[i].data(), 2 * voxels, block.slot * 2 * voxels);
    }
  }
}

inline DenseGrid denseGrid(const MapParameters& map, const SignedDistance& distance,
                           const Eigen::Vector3i& first_block, int blocks) {
  DenseGrid grid(map.block_size * first_block, map.block_size * blocks);
  grid.forEachVoxel(
      [&](const Eigen::Vector3i& voxel) { grid.at(voxel) = distanceByte(map, distance, voxel); });
  return grid;
}

}  // namespace depth_fusion
