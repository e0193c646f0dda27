// Parts of a whole map, one at a time, in a map of their own.
#pragma once

#include <memory>

#include "submaps/whole_map.h"

namespace depth_fusion {

class PartLoader {
 public:
  // For boxes of so many blocks to each axis, which with the groups about them have so many blocks in all. Of
  // the layers, those are loaded that maps with these parameters have.
  PartLoader(ComputeContext& compute, const MapParameters& parameters, int edge_blocks, size_t most_blocks);

  // Has map() hold the blocks of the box and of the groups about it, and no others. Throws Error if they
  // cannot be read, or are too many.
  void load(WholeMap& world, const BlockBox& box);
  BlockMap& map() { return *map_; }

 private:
  int edge_;
  std::vector<LayerRow> layers_;
  std::unique_ptr<BlockMap> map_;
};

}  // namespace depth_fusion
