#include "depth_fusion/map/map_changes.h"

#include <algorithm>
#include <atomic>
#include <set>
#include <utility>

namespace depth_fusion {
namespace {

uint32_t newGeneration() {
  static std::atomic<uint32_t> last{0};
  return ++last;
}

}  // namespace

MapChanges MapSubscription::take() {
  const uint64_t step = std::exchange(seen_, log_->step_);
  return log_->changesSince(step);
}

ChangeLog::ChangeLog(const SlotTable& slots, size_t max_departed)
    : slots_(slots),
      max_departed_(max_departed),
      generation_(newGeneration()),
      followers_(std::make_shared<int>()) {}

MapSubscription ChangeLog::subscribe() { return MapSubscription(*this, followers_); }

bool ChangeLog::beginStep() {
  ++step_;
  if (isFollowed()) return true;
  // The next follower is told of everything all the same.
  departed_.clear();
  return false;
}

void ChangeLog::noteUpdated(const std::vector<int>& slots) {
  if (!beginStep()) return;
  updated_at_.resize(std::max(updated_at_.size(), static_cast<size_t>(slots_.bound())), 0);
  for (const int slot : slots) {
    if (slots_.inUse(slot)) updated_at_[static_cast<size_t>(slot)] = step_;
  }
}

void ChangeLog::noteReleased(const std::vector<int>& slots) { noteDeparted(slots, false); }

void ChangeLog::noteEvicted(const std::vector<int>& slots) { noteDeparted(slots, true); }

void ChangeLog::noteDeparted(const std::vector<int>& slots, bool evicted) {
  if (!beginStep()) return;
  for (const int slot : slots) noteDeparture({step_, slots_.blockOf(slot), evicted, updatedAt(slot)});
}

void ChangeLog::noteChangedElsewhere(const std::vector<BlockIndex>& blocks) {
  if (!beginStep()) return;
  for (const BlockIndex& block : blocks) noteDeparture({step_, block, true, step_});
}

void ChangeLog::noteDeparture(const Departure& departure) {
  departed_.push_back(departure);
  while (departed_.size() > max_departed_) forgetOldest();
}

void ChangeLog::noteReturned(const std::vector<int>& slots) {
  for (const int slot : slots) {
    if (static_cast<size_t>(slot) < updated_at_.size()) updated_at_[static_cast<size_t>(slot)] = 0;
  }
}

uint64_t ChangeLog::updatedAt(int slot) const {
  return static_cast<size_t>(slot) < updated_at_.size() ? updated_at_[static_cast<size_t>(slot)] : 0;
}

void ChangeLog::forgetOldest() {
  complete_from_ = departed_.front().step;
  departed_.pop_front();
}

void ChangeLog::noteReset() {
  generation_ = newGeneration();
  complete_from_ = ++step_;
  updated_at_.clear();
  departed_.clear();
}

MapChanges ChangeLog::changesSince(uint64_t step) const {
  MapChanges changes;
  changes.generation = generation_;
  changes.complete = step < complete_from_;
  if (step == step_) return changes;
  std::vector<std::pair<uint64_t, int>> updated;
  for (int slot = 0; slot < slots_.bound(); ++slot) {
    const uint64_t at = updatedAt(slot);
    if (slots_.inUse(slot) && (changes.complete || at > step)) updated.emplace_back(at, slot);
  }
  std::sort(updated.begin(), updated.end());
  for (const auto& entry : updated) changes.updated.push_back(slots_.blockOf(entry.second));
  if (changes.complete) return changes;
  // What became last of a block that has come and gone again counts.
  std::set<BlockIndex, BlockOrder> told(changes.updated.begin(), changes.updated.end());
  std::set<BlockIndex, BlockOrder> released, evicted;
  for (auto entry = departed_.rbegin(); entry != departed_.rend() && entry->step > step; ++entry) {
    if (entry->evicted && entry->updated_at <= step) continue;
    if (told.insert(entry->block).second) (entry->evicted ? evicted : released).insert(entry->block);
  }
  changes.released.assign(released.begin(), released.end());
  changes.evicted.assign(evicted.begin(), evicted.end());
  return changes;
}

}  // namespace depth_fusion
