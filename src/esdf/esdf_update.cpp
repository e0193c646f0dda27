// Which distances may have changed, and what they are.
#include <algorithm>
#include <cstdlib>
#include <utility>

#include "depth_fusion/esdf/esdf.h"
#include "esdf/cell_lists.h"
#include "esdf/distance_field.h"

namespace depth_fusion {
namespace {

constexpr float kReachMargin = 2.0f;  // cells between a distance and the one that a site was chosen by

// How far apart they are at least, in cells.
float cellsBetween(const BlockIndex& a, const BlockIndex& b) {
  const Eigen::Array3i apart = ((a - b).array().abs() - 1).max(0);
  return ESDF_BLOCK * apart.cast<float>().matrix().norm();
}

}  // namespace

void Esdf::computeAll() {
  for (const auto& [block, slot] : cells_->slots()) known_changed_.insert(block);
}

std::vector<BlockIndex> Esdf::dirtyBlocks() const {
  BlockSet dirty = known_changed_;
  BlockBox about;
  for (const BlockIndex& block : sites_changed_) about.extend(block);
  for (const auto& [block, reach] : reach_) {
    if (about.isEmpty() || dirty.count(block) > 0) continue;
    const auto isInReach = [&here = block, far = reach](const BlockIndex& changed) {
      return cellsBetween(here, changed) <= far;
    };
    const BlockIndex nearest = block.cwiseMax(about.min()).cwiseMin(about.max());
    if (isInReach(nearest) && std::any_of(sites_changed_.begin(), sites_changed_.end(), isInReach))
      dirty.insert(block);
  }
  return {dirty.begin(), dirty.end()};
}

std::vector<BlockIndex> Esdf::update(StageTimers& timers) {
  const StageTimers::Scope timer(timers, "esdf/update");
  const std::vector<BlockIndex> dirty = dirtyBlocks();
  const float step_cells = grid_.stepSize_m() / static_cast<float>(grid_.cellSize_m());
  field_->compute(dirty, [&](const BlockIndex& index, const int32_t* cells) {
    EsdfGrid::Block block;
    block.steps.resize(ESDF_CELLS);
    block.states.resize(ESDF_CELLS);
    int farthest = -1;
    bool is_known = false;
    for (size_t n = 0; n < ESDF_CELLS; ++n) {
      block.steps[n] = static_cast<int16_t>(cells[n] & 0xffff);
      block.states[n] = static_cast<CellState>(static_cast<int8_t>(cells[n] >> 16 & 0xff));
      is_known = is_known || block.states[n] != CellState::kUnknown;
      if (block.steps[n] != EsdfGrid::kUnknownSteps)
        farthest = std::max(farthest, std::abs(int{block.steps[n]}));
    }
    reach_[index] = farthest < 0 ? -1.0f : step_cells * static_cast<float>(farthest) + kReachMargin;
    if (is_known) {
      grid_.blocks()[index] = std::move(block);
    } else {
      grid_.blocks().erase(index);
    }
  });
  known_changed_.clear();
  sites_changed_.clear();
  return dirty;
}

}  // namespace depth_fusion
