// What is known of space, on the host: which cells are free and which are occupied, and how far it is to the
// nearest surface.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "depth_fusion/map/slot_table.h"

namespace depth_fusion {

// A cell is occupied if a surface goes through it, or its middle lies just behind one; it is free if its
// middle was seen to be, and no surface goes through it.
enum class CellState : int8_t { kUnknown = -1, kFree = 0, kOccupied = 1 };

// The Euclidean distance to the nearest surface that was seen, negative behind it, up to the grid's largest.
struct EsdfSample {
  bool is_known = false;
  float distance_m = 0.0f;
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();  // of the distance, metres a metre; zero where it ends
};

// Cell (i, j, k) is the cube from cellSize_m() * (i, j, k) on, in W; distances are those of the cells'
// middles.
class EsdfGrid {
 public:
  static constexpr int kBlockCells = 16;  // to each axis of a block
  static constexpr int16_t kUnknownSteps = INT16_MIN;

  // Cells in the order of x, then y, then z.
  struct Block {
    std::vector<int16_t> steps;  // distances, in steps of stepSize_m()
    std::vector<CellState> states;
  };
  using Blocks = std::map<BlockIndex, Block, BlockOrder>;

  EsdfGrid(double cell_size_m, double max_distance_m)
      : cell_size_m_(cell_size_m), max_distance_m_(max_distance_m) {}

  double cellSize_m() const { return cell_size_m_; }
  double maxDistance_m() const { return max_distance_m_; }
  float stepSize_m() const { return static_cast<float>(max_distance_m_ / kStepsToMax); }
  Eigen::Vector3i cellAt(const Eigen::Vector3d& p_W) const {
    return (p_W / cell_size_m_).array().floor().cast<int>();
  }
  Eigen::Vector3d middleOf(const Eigen::Vector3i& cell) const {
    return cell_size_m_ * (cell.cast<double>().array() + 0.5).matrix();
  }

  CellState stateAt(const Eigen::Vector3i& cell) const;
  // None where it is not known.
  std::optional<float> distanceAt_m(const Eigen::Vector3i& cell) const;
  // Between the cells' middles distances are interpolated; a point is known if its cell is.
  std::vector<EsdfSample> distances(const std::vector<Eigen::Vector3d>& points_W) const;

  const Blocks& blocks() const { return blocks_; }
  Blocks& blocks() { return blocks_; }
  // Calls with each cell of the blocks, its state and, in metres, its distance; NaN where that is not known.
  template <class Function>
  void forEachCell(const Function& function) const {
    for (const auto& [index, block] : blocks_) forEachCellOf(index, block, function);
  }

 private:
  static constexpr double kStepsToMax = 32000.0;

  template <class Function>
  void forEachCellOf(const BlockIndex& index, const Block& block, const Function& function) const {
    for (int n = 0; n < kBlockCells * kBlockCells * kBlockCells; ++n) {
      const Eigen::Vector3i cell =
          kBlockCells * index +
          Eigen::Vector3i(n % kBlockCells, n / kBlockCells % kBlockCells, n / kBlockCells / kBlockCells);
      const int16_t steps = block.steps[static_cast<size_t>(n)];
      function(cell, block.states[static_cast<size_t>(n)],
               steps == kUnknownSteps ? std::numeric_limits<float>::quiet_NaN() : stepSize_m() * steps);
    }
  }

  double cell_size_m_, max_distance_m_;
  Blocks blocks_;
};

}  // namespace depth_fusion
