#include "submaps/whole_map.h"

#include <algorithm>

namespace depth_fusion {

WholeMap::WholeMap(SubmapCollection& submaps, const Groups* only)
    : layers_(submaps.layers_), block_size_(submaps.map_.parameters().block_size), active_(submaps.active_) {
  const SlotTable& slots = submaps.map_.slots();
  std::vector<int> wanted;
  for (int slot = 0; slot < slots.bound(); ++slot) {
    if (!slots.inUse(slot)) continue;
    if (only == nullptr || only->count(groupOf(slots.blockOf(slot), submaps.edge_)) > 0)
      wanted.push_back(slot);
  }
  in_pool_ = groupsIn(submaps.map_, layers_, wanted);
  std::vector<GroupKey> keys;
  for (uint32_t i = 0; i < submaps.submaps_.size(); ++i) {
    by_age_.push_back(i);
    const SubmapCollection::GroupSizes& stored = submaps.submaps_[i].stored;
    const auto add = [&](const BlockIndex& group, size_t blocks) {
      keys.push_back({i, group});
      groups_[group][i] = blocks;
    };
    if (only == nullptr) {
      for (const auto& [group, blocks] : stored) add(group, blocks);
    } else {
      for (const BlockIndex& group : *only) {
        if (const auto found = stored.find(group); found != stored.end()) add(group, found->second);
      }
    }
  }
  for (const auto& [group, blocks] : in_pool_) groups_[group][active_] += blocks.front().blocks.size();
  std::sort(by_age_.begin(), by_age_.end(), [&](uint32_t a, uint32_t b) {
    const auto left_at_m = [&](uint32_t i) { return submaps.submaps_[i].left_at_m; };
    if (a == active_ || b == active_) return a == active_;
    return left_at_m(a) != left_at_m(b) ? left_at_m(a) > left_at_m(b) : a > b;
  });
  stored_ = submaps.store_->snapshot(keys);
}

BlockGroups WholeMap::group(const GroupKey& key) {
  const auto in_pool = in_pool_.find(key.group);
  const bool is_in_pool = key.submap == active_ && in_pool != in_pool_.end();
  if (!stored_->has(key)) return is_in_pool ? in_pool->second : BlockGroups(layers_.size());
  return is_in_pool ? joined(in_pool->second, stored_->group(key)) : stored_->group(key);
}

GroupRows WholeMap::rows(const GroupKey& key) {
  const bool is_in_pool = key.submap == active_ && in_pool_.count(key.group) > 0;
  if (!is_in_pool) return *stored_->rows(key);
  return packedRows(key, group(key), layers_, block_size_);
}

BlockGroups WholeMap::groupOfWorld(const BlockIndex& index) {
  const auto found = groups_.find(index);
  BlockGroups all(layers_.size());
  if (found == groups_.end()) return all;
  for (const uint32_t submap : by_age_) {
    if (found->second.count(submap) == 0) continue;
    const BlockGroups older = group({submap, index});
    all = all.front().blocks.empty() ? older : joined(all, older);
  }
  return all;
}

}  // namespace depth_fusion
