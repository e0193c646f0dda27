// Maps whose surface changes, as fusion changes it: blocks come, change and go.
#pragma once

#include <functional>
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
  using NoteUpdated = std::function<void(const std::vector<int>&)>;

  // Keeps references.
  ChangingMap(ComputeContext& compute, BlockSparseMap& map)
      : compute_(compute),
        map_(map),
        first_(Eigen::Vector3i::Constant(-24 / map.parameters().block_size)),
        count_(48 / map.parameters().block_size) {}

  // Names the blocks that this call releases, changes or creates, and no others.
  void show(const SignedDistance& distance, const NoteUpdated& note) {
    const MapContent before = readMap(map_);
    note(release([&](const BlockSparseMap::BlockIndex& block) { return isEmpty(distance, block); }));
    BlockSparseMap scratch(compute_, map_.parameters());
    fillMap(scratch, distance, first_, count_);
    std::vector<BlockSparseMap::BlockIndex> created;
    const MapContent after = readMap(scratch);
    for (const auto& entry : after) {
      if (before.count(entry.first) == 0) created.push_back(indexOf(entry.first));
    }
    map_.allocate(created);
    std::vector<int> changed;
    for (const BlockSparseMap::Block& block : map_.blocks()) {
      const BlockContent& content = after.at(keyOf(block.index));
      const auto old = before.find(keyOf(block.index));
      if (old != before.end() && old->second == content) continue;
      write(block.slot, content);
      changed.push_back(block.slot);
    }
    note(changed);
  }

 private:
  bool isEmpty(const SignedDistance& distance, const BlockSparseMap::BlockIndex& block) const {
    const int m = map_.parameters().block_size;
    for (int v = 0; v < m * m * m; ++v) {
      if (distanceByte(map_.parameters(), distance,
                       m * block + Eigen::Vector3i(v % m, v / m % m, v / m / m)) != -128)
        return false;
    }
    return true;
  }

  template <class Condition>
  std::vector<int> release(const Condition& condition) {
    const int n = map_.parameters().blocks_per_axis;
    std::vector<int> offsets = map_.offsets().read<int>(map_.offsets().bytes() / sizeof(int));
    std::vector<int> slots;
    for (const BlockSparseMap::Block& block : map_.blocks()) {
      if (!condition(block.index)) continue;
      slots.push_back(block.slot);
      const Eigen::Vector3i wrapped = block.index.unaryExpr([n](int i) { return ((i % n) + n) % n; });
      offsets[wrapped.x() + n * (wrapped.y() + n * wrapped.z())] = BLOCK_EMPTY;
    }
    map_.offsets().write(offsets);
    map_.release(slots);
    return slots;
  }

  void write(int slot, const BlockContent& content) {
    const size_t voxels = content.distances.size();
    map_.voxels().write(content.distances.data(), voxels, 2 * voxels * slot);
    map_.voxels().write(content.certainties.data(), voxels, 2 * voxels * slot + voxels);
  }

  ComputeContext& compute_;
  BlockSparseMap& map_;
  Eigen::Vector3i first_;
  int count_;
};

}  // namespace depth_fusion
