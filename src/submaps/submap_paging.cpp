// From the store into the pool.
#include <algorithm>
#include <limits>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/submaps/submap_collection.h"
#include "map/view_volume.h"
#include "shared/types.h"
#include "submaps/block_store.h"
#include "submaps/pool_groups.h"

namespace depth_fusion {
namespace {

constexpr double kAhead_m = 1.0;  // beyond the view, from where on groups are read ahead

}  // namespace

void SubmapCollection::show(const CameraIntrinsics& camera, const Pose& T_W_D, double max_range_m) {
  follow();
  problem_.clear();
  view_ = std::make_unique<ViewVolume>(camera, T_W_D.inverse(), max_range_m);
  if (!moveWindow()) evictAhead();
  const size_t capacity = map_.slots().capacity();
  if (map_.slots().free() < capacity / 16) makeRoom(capacity / 8);
  bringBackSeen();
}

void SubmapCollection::bringBackSeen() {
  if (absent_.empty()) return;
  std::vector<BlockIndex> seen;
  std::vector<GroupKey> ahead;
  const Eigen::AlignedBox3d box = view_->box();
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kAhead_m);
  const Eigen::AlignedBox3d near(box.min() - margin, box.max() + margin);
  for (const auto& [group, submap] : absent_) {
    if (isSeen(group)) {
      seen.push_back(group);
    } else if (near.contains(middleOf(group)) && ahead_.insert(group).second) {
      ahead.push_back({submap, group});
    }
  }
  if (!ahead.empty()) store_->readAhead(ahead);
  bringBack(seen);
}

void SubmapCollection::bringBackNear(const Eigen::Vector3d& p_W) {
  std::vector<std::pair<double, BlockIndex>> near;
  for (const auto& [group, submap] : absent_) near.emplace_back(distance_m(group, p_W), group);
  std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<BlockIndex> groups;
  size_t room = map_.slots().capacity() - map_.slots().capacity() / 8;
  for (const auto& [distance, group] : near) {
    const size_t blocks = submaps_[absent_.at(group)].stored.at(group);
    if (blocks > room) break;
    room -= blocks;
    groups.push_back(group);
  }
  bringBack(groups);
}

SubmapCollection::BlockSet SubmapCollection::bringBack(const std::vector<BlockIndex>& groups) {
  size_t needed = 0;
  for (const BlockIndex& group : groups) needed += submaps_[absent_.at(group)].stored.at(group);
  makeRoom(needed);
  BlockGroups all(layers_.size());
  size_t room = map_.slots().free();
  for (const BlockIndex& group : groups) {
    if (submaps_[absent_.at(group)].stored.at(group) > room) {
      problem_ = "the pool is too small for what is in view; raise map/pool_mib or map/voxel_size_m";
      continue;
    }
    try {
      const BlockGroups part = takeFromStore(group);
      room -= part.front().blocks.size();
      for (size_t i = 0; i < all.size(); ++i) {
        all[i].blocks.insert(all[i].blocks.end(), part[i].blocks.begin(), part[i].blocks.end());
        all[i].states.insert(all[i].states.end(), part[i].states.begin(), part[i].states.end());
        all[i].voxels += part[i].voxels;
      }
    } catch (const Error& error) {
      problem_ = std::string("stored surface is missing here: ") + error.what();
    }
  }
  const std::vector<BlockIndex>& blocks = all.front().blocks;
  if (blocks.empty()) return {};
  const std::vector<int> slots = map_.insert(blocks);
  for (int& state : all.front().states)
    state |= BLOCK_SURE;  // what was stored once stays, also of versions that knew no such bit
  map_.setStates(slots, all.front().states);
  for (size_t i = 0; i < layers_.size(); ++i) map_.setVoxels(layers_[i].name, slots, all[i].voxels);
  return {blocks.begin(), blocks.end()};
}

SubmapCollection::BlockGroups SubmapCollection::takeFromStore(const BlockIndex& group) {
  const uint32_t submap = absent_.at(group);
  const BlockStore::GroupPtr stored = store_->take({submap, group});
  absent_.erase(group);
  ahead_.erase(group);
  BlockGroups outside = partOf(*stored, map_.window(), false);
  const size_t rest = outside.front().blocks.size();
  setStored(submap, group, rest);
  if (rest > 0) store_->put({submap, group}, std::move(outside));
  return partOf(*stored, map_.window(), true);
}

std::vector<BlockIndex> SubmapCollection::bringBackRequested(std::vector<BlockIndex>& requested) {
  makeRoom(requested.size());
  if (absent_.empty()) return {};
  BlockSet groups;
  for (const BlockIndex& block : requested) {
    const BlockIndex group = groupOf(block, edge_);
    if (absent_.count(group) > 0) groups.insert(group);
  }
  if (groups.empty()) return {};
  const BlockSet brought = bringBack({groups.begin(), groups.end()});
  std::vector<BlockIndex> to_make, away;
  for (const BlockIndex& block : requested) {
    if (brought.count(block) > 0) continue;
    (absent_.count(groupOf(block, edge_)) > 0 ? away : to_make).push_back(block);
  }
  requested = std::move(to_make);
  return away;
}

void SubmapCollection::listAbsent() {
  absent_.clear();
  ahead_.clear();
  const Window& window = map_.window();
  const BlockIndex first = groupOf(window.origin, edge_);
  const BlockIndex last = groupOf(window.origin.array() + window.blocks_per_axis - 1, edge_);
  constexpr int kLeast = std::numeric_limits<int>::min();
  for (uint32_t i = 0; i < submaps_.size(); ++i) {
    if (!isSure(i)) continue;
    const GroupSizes& stored = submaps_[i].stored;
    for (auto entry = stored.lower_bound({kLeast, kLeast, first.z()}); entry != stored.end(); ++entry) {
      const BlockIndex& group = entry->first;
      if (group.z() > last.z()) break;
      if ((group.array() >= first.array()).all() && (group.array() <= last.array()).all()) absent_[group] = i;
    }
  }
}

bool SubmapCollection::isSeen(const BlockIndex& group) const {
  return view_->meets(middleOf(group), Eigen::Vector3d::Constant((0.5 * edge_ + 1.0) * block_m_));
}

double SubmapCollection::distance_m(const BlockIndex& group, const Eigen::Vector3d& p_W) const {
  return (middleOf(group) - p_W).norm();
}

Eigen::Vector3d SubmapCollection::middleOf(const BlockIndex& group) const {
  return block_m_ * edge_ * (group.cast<double>().array() + 0.5).matrix();
}

std::string SubmapCollection::problem() const {
  const std::string store_problem = store_->usage().problem;
  if (!problem_.empty() || store_problem.empty()) return problem_;
  return "what the sensor has left behind stays in memory: " + store_problem;
}

}  // namespace depth_fusion
