// Where the ground is, on which a robot drives.
#pragma once

#include <cstddef>
#include <vector>

#include "depth_fusion/esdf/esdf_grid.h"
#include "depth_fusion/esdf/floor_grid_parameters.h"

namespace depth_fusion {

// The cells of space, upright columns of them, numbered along x, then y. A level counts cells along z.
class Columns {
 public:
  // Space has blocks.
  explicit Columns(const EsdfGrid& space);

  Eigen::Vector2i first() const { return first_.head<2>(); }
  int width() const { return size_.x(); }
  int depth() const { return size_.y(); }
  size_t count() const { return static_cast<size_t>(size_.x()) * static_cast<size_t>(size_.y()); }
  CellState at(size_t column, int level) const {
    const int above = level - first_.z();
    return above < 0 || above >= size_.z() ? CellState::kUnknown : states_[place(column, above)];
  }
  // Levels of surfaces with free space above, from below.
  const std::vector<int>& supports(size_t column) const { return supports_[column]; }

 private:
  size_t place(size_t column, int above) const {
    return column * static_cast<size_t>(size_.z()) + static_cast<size_t>(above);
  }

  Eigen::Vector3i first_, size_;
  std::vector<CellState> states_;
  std::vector<std::vector<int>> supports_;
};

// The ground's level in each column: where it cannot be seen, that of what is near.
std::vector<int> groundLevels(const Columns& columns, double cell_size_m,
                              const FloorGridParameters& parameters);

}  // namespace depth_fusion
