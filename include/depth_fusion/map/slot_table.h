// The table of the slots of a map's memory and of the blocks in them.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "depth_fusion/map/block_index.h"

namespace depth_fusion {

using BlockBox = Eigen::AlignedBox3i;  // its corners are blocks inside

// The cube of so many blocks to each axis from the first one on.
inline BlockBox cubeFrom(const BlockIndex& first, int edge_blocks) {
  return {first, (first.array() + edge_blocks - 1).matrix().eval()};
}

// Calls with each block of the box, by z, then y, then x.
template <class Function>
void forEachIn(const BlockBox& box, const Function& function) {
  for (int z = box.min().z(); z <= box.max().z(); ++z) {
    for (int y = box.min().y(); y <= box.max().y(); ++y) {
      for (int x = box.min().x(); x <= box.max().x(); ++x) function(BlockIndex(x, y, z));
    }
  }
}

// Slots are numbered from 0 on. Those released last are given away first, in their order. It lives on the
// host alone; the way back, from a block to its slot, is the map's `offsets` on the device.
class SlotTable {
 public:
  struct Block {
    BlockIndex index;
    int slot;
  };

  explicit SlotTable(size_t capacity);

  // Slots for the first of the blocks, as long as there are free ones. None of the blocks has a slot yet.
  std::vector<int> take(const std::vector<BlockIndex>& blocks);
  // Throws Error for a slot that is not in use.
  void release(const std::vector<int>& slots);
  void clear();
  // A copy with room for bound() blocks, one at least.
  SlotTable trimmed() const;

  size_t capacity() const { return capacity_; }
  size_t free() const { return free_.size(); }
  size_t used() const { return capacity_ - free_.size(); }

  // Slots [0, bound()) have been in use at some time since the table was empty.
  int bound() const { return static_cast<int>(entries_.size()); }
  // These are for slots below bound(). A slot that is not in use still tells the block that it held last.
  bool inUse(int slot) const { return entries_[static_cast<size_t>(slot)].in_use; }
  const BlockIndex& blockOf(int slot) const { return entries_[static_cast<size_t>(slot)].block; }
  // The blocks in use, sorted by z, y, x.
  std::vector<Block> blocks() const;
  // The boxes about the blocks of SLOTS_PER_GROUP (kernels/shared/types.h) slots each, one after the other;
  // empty where none is in use.
  const std::vector<BlockBox>& groupBoxes() const { return group_boxes_; }

 private:
  struct Entry {
    BlockIndex block;
    bool in_use;
  };

  void updateGroupBoxes(const std::vector<int>& changed_slots);

  size_t capacity_;
  std::vector<int> free_;  // the next one is the last
  std::vector<Entry> entries_;
  std::vector<BlockBox> group_boxes_;
};

}  // namespace depth_fusion
