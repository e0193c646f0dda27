#include "esdf/ground.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <limits>
#include <map>

namespace depth_fusion {
namespace {

constexpr int kNone = std::numeric_limits<int>::min();

// The support that is nearest to a level; kNone if none is within reach.
int supportNear(const std::vector<int>& supports, int level, int reach) {
  int nearest = kNone;
  for (const int support : supports) {
    const bool is_nearer = nearest == kNone || std::abs(support - level) < std::abs(nearest - level);
    if (std::abs(support - level) <= reach && is_nearer) nearest = support;
  }
  return nearest;
}

int mostFrequentSupport(const Columns& columns) {
  std::map<int, size_t> counts;
  for (size_t column = 0; column < columns.count(); ++column) {
    for (const int level : columns.supports(column)) ++counts[level];
  }
  int best = 0;
  size_t most = 0;
  for (const auto& [level, count] : counts) {
    if (count > most) best = level;
    most = std::max(most, count);
  }
  return best;
}

// Goes on from the columns that have a level to those beside them: levelOf(column, level beside) says which
// level they get, or kNone.
template <class LevelOf>
void spread(const Columns& columns, std::vector<int>& levels, const LevelOf& levelOf) {
  std::deque<size_t> waiting;
  for (size_t column = 0; column < columns.count(); ++column) {
    if (levels[column] != kNone) waiting.push_back(column);
  }
  const auto width = static_cast<size_t>(columns.width());
  for (; !waiting.empty(); waiting.pop_front()) {
    const size_t from = waiting.front(), x = from % width;
    const auto visit = [&](bool is_there, size_t column) {
      if (!is_there || levels[column] != kNone) return;
      levels[column] = levelOf(column, levels[from]);
      if (levels[column] != kNone) waiting.push_back(column);
    };
    visit(x > 0, from - 1);
    visit(x + 1 < width, from + 1);
    visit(from >= width, from - width);
    visit(from + width < columns.count(), from + width);
  }
}

}  // namespace

Columns::Columns(const EsdfGrid& space) {
  constexpr int kEdge = EsdfGrid::kBlockCells;
  BlockBox box;
  for (const auto& entry : space.blocks()) box.extend(entry.first);
  first_ = kEdge * box.min();
  size_ = (kEdge * (box.sizes().array() + 1)).matrix();
  states_.assign(count() * static_cast<size_t>(size_.z()), CellState::kUnknown);
  space.forEachCell([&](const Eigen::Vector3i& cell, CellState state, float) {
    const Eigen::Vector3i in_box = cell - first_;
    const size_t column =
        static_cast<size_t>(in_box.x()) + static_cast<size_t>(in_box.y()) * static_cast<size_t>(size_.x());
    states_[place(column, in_box.z())] = state;
  });
  supports_.resize(count());
  for (size_t column = 0; column < count(); ++column) {
    for (int above = 0; above + 1 < size_.z(); ++above) {
      if (states_[place(column, above)] == CellState::kOccupied &&
          states_[place(column, above + 1)] == CellState::kFree)
        supports_[column].push_back(first_.z() + above);
    }
  }
}

std::vector<int> groundLevels(const Columns& columns, double cell_size_m,
                              const FloorGridParameters& parameters) {
  const int level = parameters.find_ground
                        ? mostFrequentSupport(columns)
                        : static_cast<int>(std::floor(parameters.ground_z_m / cell_size_m));
  const int step = static_cast<int>(std::floor(parameters.max_step_m / cell_size_m + 1e-3));
  std::vector<int> levels(columns.count(), kNone);
  if (step > 0) {
    for (size_t column = 0; column < columns.count(); ++column)
      levels[column] = supportNear(columns.supports(column), level, 1);
    spread(columns, levels,
           [&](size_t column, int beside) { return supportNear(columns.supports(column), beside, step); });
    spread(columns, levels, [](size_t, int beside) { return beside; });
  }
  for (int& of_column : levels) {
    if (of_column == kNone) of_column = level;
  }
  return levels;
}

}  // namespace depth_fusion
