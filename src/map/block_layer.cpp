#include "depth_fusion/map/block_layer.h"

#include <cstdint>

#include "shared/types.h"

namespace depth_fusion {
namespace {

const std::vector<LayerRow>& layerTable() {
  static const std::vector<LayerRow> table = {
      {kTsdfLayer, {{1, TSDF_CHI}, {1, 0}}, nullptr},
      {kColorLayer, {{4, 0}}, &MapParameters::color},
  };
  return table;
}

// The bytes of a block of which nothing is known.
std::vector<uint8_t> clearedBytes(const LayerRow& row, int block_size) {
  const size_t voxels = row.bytesPerBlock(block_size) / row.bytesPerVoxel();
  std::vector<uint8_t> bytes;
  for (const LayerPlane& plane : row.planes) {
    for (size_t i = 0; i < voxels * plane.bytes_per_voxel; ++i) {
      const auto value = static_cast<uint32_t>(plane.clear_value);
      bytes.push_back(static_cast<uint8_t>(value >> (8 * (i % plane.bytes_per_voxel))));
    }
  }
  return bytes;
}

}  // namespace

size_t LayerRow::bytesPerVoxel() const {
  size_t bytes = 0;
  for (const LayerPlane& plane : planes) bytes += plane.bytes_per_voxel;
  return bytes;
}

size_t LayerRow::bytesPerBlock(int block_size) const {
  const auto m = static_cast<size_t>(block_size);
  return m * m * m * bytesPerVoxel();
}

std::vector<LayerRow> layersOf(const MapParameters& map) {
  std::vector<LayerRow> rows;
  for (const LayerRow& row : layerTable()) {
    if (row.wanted == nullptr || map.*row.wanted) rows.push_back(row);
  }
  return rows;
}

BlockLayer::BlockLayer(ComputeContext& compute, const LayerRow& row, int block_size, size_t capacity)
    : row_(row),
      buffer_(compute, capacity * row.bytesPerBlock(block_size),
              ("the map's layer " + row.name + " of map/pool_mib").c_str()),
      cleared_block_(compute, row.bytesPerBlock(block_size), "a block without contents") {
  cleared_block_.write(clearedBytes(row, block_size));
}

}  // namespace depth_fusion
