// A block's place in the grid of all blocks.
#pragma once

#include <Eigen/Core>
#include <tuple>

namespace depth_fusion {

// Block (i, j, k) covers the voxels M*(i, j, k) and on, M to each axis.
using BlockIndex = Eigen::Vector3i;

// Lists of blocks are in this order: by z, then y, then x.
inline bool before(const BlockIndex& a, const BlockIndex& b) {
  return std::make_tuple(a.z(), a.y(), a.x()) < std::make_tuple(b.z(), b.y(), b.x());
}

// Containers are ordered by it in the same way.
struct BlockOrder {
  bool operator()(const BlockIndex& a, const BlockIndex& b) const { return before(a, b); }
};

}  // namespace depth_fusion
