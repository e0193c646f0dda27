// From the pool into the store.
#include <algorithm>
#include <cstdlib>
#include <utility>

#include "depth_fusion/common/error.h"
#include "depth_fusion/submaps/submap_collection.h"
#include "map/view_volume.h"
#include "shared/types.h"
#include "submaps/block_store.h"
#include "submaps/pool_groups.h"

namespace depth_fusion {
namespace {

// So many blocks that the window will leave are evicted with a frame.
constexpr size_t kEvictedAhead = 2048;

// The greatest multiple of the edge that is not above the number.
int alignedDown(int number, int edge) { return (number >= 0 ? number : number - edge + 1) / edge * edge; }

// Where, along an axis, a window of n blocks begins that has the blocks from `first` to `last` inside and
// lies on the grid of groups.
int movedAlong(int origin, int n, int first, int last, int edge) {
  const bool fits = last - first + 1 + 2 * edge <= n;
  if (!fits) {
    // The window is smaller than the view: it has the view's middle in its own.
    const int middle = alignedDown((first + last + 1 - n) / 2, edge);
    return std::abs(middle - origin) > n / 4 ? middle : origin;
  }
  if (first < origin) return alignedDown(first - edge, edge);
  if (last >= origin + n) return alignedDown(last + 1 - n + 2 * edge - 1, edge);
  const int below = alignedDown(origin, edge);
  return last < below + n ? below : alignedDown(origin + edge - 1, edge);
}

}  // namespace

bool SubmapCollection::moveWindow() {
  const Window& window = map_.window();
  const BlockIndex first = blockAt(view_->box().min()).array() - 1;
  const BlockIndex last = blockAt(view_->box().max()).array() + 1;
  if (window.contains(first) && window.contains(last)) return false;
  Window moved = window;
  for (int axis = 0; axis < 3; ++axis)
    moved.origin[axis] =
        movedAlong(window.origin[axis], window.blocks_per_axis, first[axis], last[axis], edge_);
  const BlockIndex step = moved.origin - window.origin;
  if (step.isZero()) return false;
  std::vector<int> outside;
  for (const auto& [group, slots] : slotsOutside(moved))
    outside.insert(outside.end(), slots.begin(), slots.end());
  if (!evict(outside)) return false;
  map_.moveWindow(moved.origin);
  listAbsent();
  moved.origin += 2 * edge_ * step.cwiseSign();
  leaving_ = slotsOutside(moved);
  return true;
}

SubmapCollection::GroupSlots SubmapCollection::slotsOutside(const Window& window) const {
  GroupSlots groups;
  for (int slot = 0; slot < map_.slots().bound(); ++slot) {
    const BlockIndex& block = map_.slots().blockOf(slot);
    if (map_.slots().inUse(slot) && !window.contains(block)) groups[groupOf(block, edge_)].push_back(slot);
  }
  return groups;
}

void SubmapCollection::evictAhead() {
  if (leaving_.empty() || !store_->hasRoom()) return;
  std::vector<int> evicted;
  while (!leaving_.empty() && evicted.size() < kEvictedAhead) {
    const auto& [group, slots] = *leaving_.begin();
    for (const int slot : slots) {
      const bool is_there = map_.slots().inUse(slot) && groupOf(map_.slots().blockOf(slot), edge_) == group;
      if (is_there && !isSeen(group)) evicted.push_back(slot);
    }
    leaving_.erase(leaving_.begin());
  }
  evict(evicted);
}

bool SubmapCollection::evict(std::vector<int> slots) {
  if (slots.empty()) return true;
  if (!store_->hasRoom()) {
    problem_ = "what the sensor has left behind cannot be stored (" + store_->usage().problem +
               "), and its memory is full: new surface is left out";
    return false;
  }
  dropUnsure(slots);
  if (slots.empty()) return true;
  BlockSet kept;
  for (auto& [group, blocks] : groupsIn(map_, layers_, slots)) {
    try {
      store(group, std::move(blocks));
    } catch (const Error& error) {
      problem_ = std::string("what the sensor has left behind stays in the pool: ") + error.what();
      kept.insert(group);
    }
  }
  const auto isKept = [&](int slot) { return kept.count(groupOf(map_.slots().blockOf(slot), edge_)) > 0; };
  if (!kept.empty()) slots.erase(std::remove_if(slots.begin(), slots.end(), isKept), slots.end());
  map_.evict(slots);
  return kept.empty();
}

void SubmapCollection::dropUnsure(std::vector<int>& slots) {
  const std::vector<int> states = map_.states(slots);
  std::vector<int> sure, unsure;
  for (size_t i = 0; i < slots.size(); ++i) (states[i] & BLOCK_SURE ? sure : unsure).push_back(slots[i]);
  map_.remove(unsure);
  slots = std::move(sure);
}

void SubmapCollection::store(const BlockIndex& group, BlockGroups blocks) {
  // Other parts of the group, which may be stored with other submaps.
  std::vector<std::pair<uint32_t, BlockStore::GroupPtr>> others;
  try {
    for (uint32_t i = 0; i < submaps_.size(); ++i) {
      if (isSure(i) && submaps_[i].stored.count(group) > 0) others.emplace_back(i, store_->take({i, group}));
    }
  } catch (const Error&) {
    for (const auto& [submap, other] : others) store_->put({submap, group}, *other);
    throw;
  }
  for (const auto& [submap, other] : others) {
    blocks = joined(blocks, *other);
    setStored(submap, group, 0);
  }
  setStored(active_, group, blocks.front().blocks.size());
  store_->put({active_, group}, std::move(blocks));
  absent_[group] = active_;
}

void SubmapCollection::makeRoom(size_t slots) {
  if (map_.slots().free() >= slots || view_ == nullptr) return;
  std::vector<std::pair<double, std::vector<int>>> hidden;  // by their distance
  for (auto& [group, of_group] : slotsOutside({BlockIndex::Zero(), 0})) {
    if (!isSeen(group)) hidden.emplace_back(distance_m(group, view_->box().center()), of_group);
  }
  std::sort(hidden.rbegin(), hidden.rend());
  std::vector<int> evicted;
  for (const auto& [distance, of_group] : hidden) {
    if (map_.slots().free() + evicted.size() >= slots) break;
    evicted.insert(evicted.end(), of_group.begin(), of_group.end());
  }
  evict(evicted);
}

}  // namespace depth_fusion
