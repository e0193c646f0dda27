// The part of the grid of blocks that a map can hold.
#pragma once

#include <cmath>
#include <cstddef>

#include "depth_fusion/map/block_index.h"

namespace depth_fusion {

// A cube of N^3 blocks. A block's address is its index modulo N in each axis, so that the window may start
// anywhere, and a block that stays in it while it moves keeps its address.
struct Window {
  BlockIndex origin = BlockIndex::Zero();  // the first block
  int blocks_per_axis = 0;                 // N

  // The window whose middle is the block with the point; block_m is the edge of a block.
  static Window centredOn(const Eigen::Vector3d& p_W, double block_m, int blocks_per_axis) {
    const Eigen::Vector3i middle = (p_W / block_m).array().floor().cast<int>();
    return {middle.array() - blocks_per_axis / 2, blocks_per_axis};
  }

  bool contains(const BlockIndex& block) const {
    const Eigen::Array3i local = (block - origin).array();
    return (local >= 0).all() && (local < blocks_per_axis).all();
  }

  // The index modulo N in each axis, from 0 on.
  BlockIndex wrapped(const BlockIndex& block) const {
    return block.unaryExpr([n = blocks_per_axis](int i) { return (i % n + n) % n; });
  }

  // A block's place, from 0 on, in arrays with an element for each block of the window.
  size_t address(const BlockIndex& block) const {
    const auto n = static_cast<size_t>(blocks_per_axis);
    const Eigen::Matrix<size_t, 3, 1> place = wrapped(block).cast<size_t>();
    return place.x() + n * (place.y() + n * place.z());
  }

  size_t blockCount() const {
    const auto n = static_cast<size_t>(blocks_per_axis);
    return n * n * n;
  }
};

}  // namespace depth_fusion
