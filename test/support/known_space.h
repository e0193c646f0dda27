// Space of which a test says what is known.
#pragma once

#include <functional>

#include "depth_fusion/esdf/esdf_grid.h"

namespace depth_fusion {

// Cells of 5 cm in `blocks` from the origin on; their distances are those of the nearest whole number of
// metres and say nothing.
inline EsdfGrid knownSpace(const Eigen::Vector3i& blocks,
                           const std::function<CellState(const Eigen::Vector3d&)>& stateAt) {
  EsdfGrid space(0.05, 2.0);
  forEachIn(BlockBox(BlockIndex::Zero(), (blocks.array() - 1).matrix()), [&](const BlockIndex& index) {
    constexpr int n = EsdfGrid::kBlockCells;
    EsdfGrid::Block& block = space.blocks()[index];
    for (int i = 0; i < n * n * n; ++i) {
      const Eigen::Vector3i cell = n * index + Eigen::Vector3i(i % n, i / n % n, i / n / n);
      block.states.push_back(stateAt(space.middleOf(cell)));
      block.steps.push_back(block.states.back() == CellState::kUnknown ? EsdfGrid::kUnknownSteps
                                                                       : int16_t{16000});
    }
  });
  return space;
}

}  // namespace depth_fusion
