// What a map holds of each voxel: one layer for each kind of thing.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/map/map_parameters.h"

namespace depth_fusion {

// The names of the layers that stages read and write.
constexpr char kTsdfLayer[] = "tsdf";    // signed distances (-128 = chi), then certainties (0 = none)
constexpr char kColorLayer[] = "color";  // blue, green, red and weight (0 = none), from the lowest byte on

// A slot of a layer is a row of planes, each with an element of 1, 2 or 4 bytes for each of the M^3 voxels.
struct LayerPlane {
  size_t bytes_per_voxel;
  int clear_value;  // of a voxel of which nothing is known
};

struct LayerRow {
  std::string name;
  std::vector<LayerPlane> planes;
  bool MapParameters::*wanted;  // null: every map has the layer

  size_t bytesPerVoxel() const;
  // The bytes of a block of block_size^3 voxels.
  size_t bytesPerBlock(int block_size) const;
};

// The layers of a map with these parameters: the TSDF first. Their table in src/map/block_layer.cpp is the
// one place that says what a map is made of.
std::vector<LayerRow> layersOf(const MapParameters& map);

// A layer's memory on the device, a block a slot.
class BlockLayer {
 public:
  BlockLayer(ComputeContext& compute, const LayerRow& row, int block_size, size_t capacity);

  const LayerRow& row() const { return row_; }
  const std::string& name() const { return row_.name; }
  size_t bytesPerVoxel() const { return row_.bytesPerVoxel(); }
  DeviceBuffer& buffer() { return buffer_; }
  const DeviceBuffer& buffer() const { return buffer_; }
  // A block of which nothing is known.
  const DeviceBuffer& clearedBlock() const { return cleared_block_; }

 private:
  LayerRow row_;
  DeviceBuffer buffer_, cleared_block_;
};

}  // namespace depth_fusion
