// Clears parts of a map.
#include <algorithm>

#include "depth_fusion/submaps/submap_collection.h"
#include "submaps/block_store.h"
#include "submaps/pool_groups.h"

namespace depth_fusion {
namespace {

// Clears voxels of groups.
class Eraser {
 public:
  Eraser(const BlockMap& map, const std::vector<LayerRow>& layers,
         const std::function<bool(const Eigen::Vector3d&)>& isInside)
      : block_size_(map.parameters().block_size),
        voxel_size_m_(static_cast<double>(map.parameters().voxel_size_m)),
        layers_(layers),
        isInside_(isInside) {}

  // What is left of the group: blocks that had a voxel inside are counted, those that had all are left out.
  BlockGroups clear(const BlockGroups& group) {
    BlockGroups rest(group.size());
    for (size_t i = 0; i < group.front().blocks.size(); ++i) {
      const std::vector<bool> inside = voxelsInside(group.front().blocks[i]);
      const auto count = std::count(inside.begin(), inside.end(), true);
      if (count > 0) ++blocks_;
      if (count == static_cast<std::ptrdiff_t>(inside.size())) continue;
      for (size_t layer = 0; layer < group.size(); ++layer) {
        const size_t bytes = layers_[layer].bytesPerBlock(block_size_);
        std::string voxels = group[layer].voxels.substr(i * bytes, bytes);
        if (count > 0) clearVoxels(layers_[layer], inside, voxels);
        rest[layer].blocks.push_back(group[layer].blocks[i]);
        rest[layer].states.push_back(group[layer].states[i]);
        rest[layer].voxels += voxels;
      }
    }
    return rest;
  }
  size_t blocks() const { return blocks_; }

 private:
  std::vector<bool> voxelsInside(const BlockIndex& block) const {
    std::vector<bool> inside;
    for (int z = 0; z < block_size_; ++z) {
      for (int y = 0; y < block_size_; ++y) {
        for (int x = 0; x < block_size_; ++x)
          inside.push_back(
              isInside_(voxel_size_m_ * (block_size_ * block + BlockIndex(x, y, z)).cast<double>()));
      }
    }
    return inside;
  }

  static void clearVoxels(const LayerRow& layer, const std::vector<bool>& inside, std::string& block) {
    size_t at = 0;
    for (const LayerPlane& plane : layer.planes) {
      for (const bool is_inside : inside) {
        if (is_inside)
          block.replace(at, plane.bytes_per_voxel, reinterpret_cast<const char*>(&plane.clear_value),
                        plane.bytes_per_voxel);
        at += plane.bytes_per_voxel;
      }
    }
  }

  int block_size_;
  double voxel_size_m_;
  const std::vector<LayerRow>& layers_;
  const std::function<bool(const Eigen::Vector3d&)>& isInside_;
  size_t blocks_ = 0;
};

}  // namespace

size_t SubmapCollection::clear(const Eigen::AlignedBox3d& box_W,
                               const std::function<bool(const Eigen::Vector3d& p_W)>& isInside) {
  follow();
  const BlockBox box(blockAt(box_W.min()), blockAt(box_W.max()));
  Eraser eraser(map_, layers_, isInside);
  clearInPool(box, [&](const BlockGroups& group) { return eraser.clear(group); });
  clearInStore(box, [&](const BlockGroups& group) { return eraser.clear(group); });
  return eraser.blocks();
}

void SubmapCollection::clearInPool(const BlockBox& box, const Edit& edit) {
  std::vector<SlotTable::Block> blocks;
  for (const SlotTable::Block& block : map_.slots().blocks()) {
    if (box.contains(block.index)) blocks.push_back(block);
  }
  // Blocks as they are listed here are in one group for this.
  std::vector<int> slots;
  BlockGroups all(layers_.size());
  for (const SlotTable::Block& block : blocks) {
    slots.push_back(block.slot);
    for (BlockGroup& layer : all) layer.blocks.push_back(block.index);
  }
  const std::vector<int> states = map_.states(slots);
  for (size_t layer = 0; layer < layers_.size(); ++layer) {
    all[layer].states = states;
    all[layer].voxels = map_.voxels(layers_[layer].name, slots);
  }
  const BlockGroups rest = edit(all);
  std::vector<int> kept, gone;
  for (const SlotTable::Block& block : blocks) {
    const std::vector<BlockIndex>& left = rest.front().blocks;
    const bool is_left = kept.size() < left.size() && left[kept.size()] == block.index;
    (is_left ? kept : gone).push_back(block.slot);
  }
  for (size_t layer = 0; layer < layers_.size(); ++layer)
    map_.setVoxels(layers_[layer].name, kept, rest[layer].voxels);
  map_.noteUpdated(kept);
  map_.remove(gone);
}

void SubmapCollection::clearInStore(const BlockBox& box, const Edit& edit) {
  const BlockBox groups(groupOf(box.min(), edge_), groupOf(box.max(), edge_));
  for (uint32_t i = 0; i < submaps_.size(); ++i) {
    std::vector<BlockIndex> met;
    for (const auto& [group, count] : submaps_[i].stored) {
      if (groups.contains(group)) met.push_back(group);
    }
    for (const BlockIndex& group : met) {
      const BlockStore::GroupPtr before = store_->take({i, group});
      BlockGroups rest = edit(*before);
      map_.noteChangedElsewhere(before->front().blocks);
      setStored(i, group, rest.front().blocks.size());
      if (!rest.front().blocks.empty()) store_->put({i, group}, std::move(rest));
    }
  }
  listAbsent();
}

}  // namespace depth_fusion
