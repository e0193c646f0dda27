#include "depth_fusion/map/slot_table.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "depth_fusion/common/error.h"
#include "shared/types.h"

namespace depth_fusion {

SlotTable::SlotTable(size_t capacity) : capacity_(capacity) { clear(); }

void SlotTable::clear() {
  free_.resize(capacity_);
  std::iota(free_.rbegin(), free_.rend(), 0);
  entries_.clear();
  group_boxes_.clear();
}

std::vector<int> SlotTable::take(const std::vector<BlockIndex>& blocks) {
  std::vector<int> slots;
  for (const BlockIndex& block : blocks) {
    if (free_.empty()) break;
    const int slot = free_.back();
    free_.pop_back();
    slots.push_back(slot);
    if (slot >= bound()) entries_.resize(static_cast<size_t>(slot) + 1, {BlockIndex::Zero(), false});
    entries_[static_cast<size_t>(slot)] = {block, true};
  }
  updateGroupBoxes(slots);
  return slots;
}

void SlotTable::release(const std::vector<int>& slots) {
  for (auto slot = slots.rbegin(); slot != slots.rend(); ++slot) {
    check(*slot >= 0 && *slot < bound() && inUse(*slot), "the map releases a block that is not in use");
    entries_[static_cast<size_t>(*slot)].in_use = false;
    free_.push_back(*slot);
  }
  updateGroupBoxes(slots);
}

SlotTable SlotTable::trimmed() const {
  SlotTable table = *this;
  table.capacity_ = std::max<size_t>(entries_.size(), 1);
  table.free_.clear();
  for (int slot = 0; slot < static_cast<int>(table.capacity_); ++slot) {
    if (slot >= bound() || !inUse(slot)) table.free_.push_back(slot);
  }
  return table;
}

std::vector<SlotTable::Block> SlotTable::blocks() const {
  std::vector<Block> blocks;
  for (int slot = 0; slot < bound(); ++slot) {
    if (inUse(slot)) blocks.push_back({blockOf(slot), slot});
  }
  std::sort(blocks.begin(), blocks.end(),
            [](const Block& a, const Block& b) { return before(a.index, b.index); });
  return blocks;
}

void SlotTable::updateGroupBoxes(const std::vector<int>& changed_slots) {
  group_boxes_.resize((entries_.size() + SLOTS_PER_GROUP - 1) / SLOTS_PER_GROUP);
  int last_group = -1;
  for (const int slot : changed_slots) {
    const int group = slot / SLOTS_PER_GROUP;
    if (group == std::exchange(last_group, group)) continue;
    BlockBox& box = group_boxes_[static_cast<size_t>(group)];
    box.setEmpty();
    const int end = std::min((group + 1) * SLOTS_PER_GROUP, bound());
    for (int i = group * SLOTS_PER_GROUP; i < end; ++i) {
      if (inUse(i)) box.extend(blockOf(i));
    }
  }
}

}  // namespace depth_fusion
