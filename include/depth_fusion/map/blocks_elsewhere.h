// Blocks that belong to a map, and are not in it now.
#pragma once

#include <vector>

#include "depth_fusion/map/block_map.h"

namespace depth_fusion {

class BlocksElsewhere {
 public:
  virtual ~BlocksElsewhere() = default;
  // Boxes that have all of them.
  virtual std::vector<BlockBox> boxes() const = 0;
  // A map that has the blocks of a cube and those about it, until the next call: always the same one; null if
  // the map that is followed has all that there are. All the cubes are of one size.
  virtual BlockMap* load(const BlockBox& box) = 0;
};

}  // namespace depth_fusion
