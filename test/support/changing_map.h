// Maps whose surface changes, as fusion changes it: blocks come, change and go.
#pragma once

#include <vector>

#include "reference/map_from_distance.h"
#include "shared/types.h"
#include "support/map_contents.h"

namespace depth_fusion {

inline SignedDistance nothing() {
  return [](const Eigen::Vector3d&) { return 1.0; };
}

// Lets a map show one surface after the other, within 24 voxels of the origin.
class ChangingMap {
 public:
  // Keeps references.
  ChangingMap(ComputeContext& compute, BlockMap& map)
      : compute_(compute),
        map_(map),
        first_(Eigen::Vector3i::Constant(-24 / map.parameters().block_size)),
        count_(48 / map.parameters().block_size) {}

  // Notes the blocks that this releases, changes or creates, and no others.
  void show(const SignedDistance& distance) {
    const MapContent before = readMap(map_);
    release([&](const BlockIndex& block) { return isEmpty(distance, block); });
    BlockMap scratch(compute_, map_.parameters());
    fillMap(scratch, distance, first_, count_);
    std::vector<BlockIndex> created;
    const MapContent after = readMap(scratch);
    for (const auto& entry : after) {
      if (before.count(entry.first) == 0) created.push_back(indexOf(entry.first));
    }
    map_.allocate(created);
    std::vector<int> changed;
    for (const SlotTable::Block& block : map_.slots().blocks()) {
      const BlockContent& content = after.at(keyOf(block.index));
      const auto old = before.find(keyOf(block.index));
      if (old != before.end() && old->second == content) continue;
      write(block.slot, content);
      changed.push_back(block.slot);
    }
    map_.noteUpdated(changed);
  }

 private:
  bool isEmpty(const SignedDistance& distance, const BlockIndex& block) const {
    const int m = map_.parameters().block_size;
    for (int v = 0; v < m * m * m; ++v) {
      if (distanceByte(map_.parameters(), distance,
                       m * block + Eigen::Vector3i(v % m, v / m % m, v / m / m)) != -128)
        return false;
    }
    return true;
  }

  template <class Condition>
  void release(const Condition& condition) {
    std::vector<int> offsets = map_.offsets().read<int>(map_.offsets().bytes() / sizeof(int));
    std::vector<int> slots;
    for (const SlotTable::Block& block : map_.slots().blocks()) {
      if (!condition(block.index)) continue;
      slots.push_back(block.slot);
      offsets[map_.window().address(block.index)] = BLOCK_EMPTY;
    }
    map_.offsets().write(offsets);
    map_.release(slots);
  }

  void write(int slot, const BlockContent& content) {
    const size_t voxels = content.distances.size();
    map_.layer(kTsdfLayer).write(content.distances.data(), voxels, 2 * voxels * slot);
    map_.layer(kTsdfLayer).write(content.certainties.data(), voxels, 2 * voxels * slot + voxels);
  }

  ComputeContext& compute_;
  BlockMap& map_;
  Eigen::Vector3i first_;
  int count_;
};

}  // namespace depth_fusion
