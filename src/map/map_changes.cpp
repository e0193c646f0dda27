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

ChangeLog::ChangeLog(const SlotTable& slots, size_t max_released)
    : slots_(slots),
      max_released_(max_released),
      generation_(newGeneration()),
      followers_(std::make_shared<int>()) {}

MapSubscription ChangeLog::subscribe() { return MapSubscription(*this, followers_); }

bool ChangeLog::beginStep() {
  ++step_;
  if (isFollowed()) return true;
  // The next follower is told of everything all the same.
  released_.clear();
  return false;
}

void ChangeLog::noteUpdated(const std::vector<int>& slots) {
  if (!beginStep()) return;
  updated_at_.resize(std::max(updated_at_.size(), static_cast<size_t>(slots_.bound())), 0);
  for (const int slot : slots) {
    if (slots_.inUse(slot)) updated_at_[static_cast<size_t>(slot)] = step_;
  }
}

void ChangeLog::noteReleased(const std::vector<int>& slots) {
  if (!beginStep()) return;
  for (const int slot : slots) released_.push_back({step_, slots_.blockOf(slot)});
  while (released_.size() > max_released_) forgetOldest();
}

void ChangeLog::forgetOldest() {
  complete_from_ = released_.front().step;
  released_.pop_front();
}

void ChangeLog::noteReset() {
  generation_ = newGeneration();
  complete_from_ = ++step_;
  updated_at_.clear();
  released_.clear();
}

MapChanges ChangeLog::changesSince(uint64_t step) const {
  MapChanges changes;
  changes.generation = generation_;
  changes.complete = step < complete_from_;
  if (step == step_) return changes;
  std::vector<std::pair<uint64_t, int>> updated;
  for (int slot = 0; slot < slots_.bound(); ++slot) {
    const size_t number = static_cast<size_t>(slot);
    const uint64_t at = number < updated_at_.size() ? updated_at_[number] : 0;
    if (slots_.inUse(slot) && (changes.complete || at > step)) updated.emplace_back(at, slot);
  }
  std::sort(updated.begin(), updated.end());
  for (const auto& entry : updated) changes.updated.push_back(slots_.blockOf(entry.second));
  if (changes.complete) return changes;
  std::set<BlockIndex, BlockOrder> released;
  for (auto entry = released_.rbegin(); entry != released_.rend() && entry->step > step; ++entry)
    released.insert(entry->block);
  for (const BlockIndex& block : changes.updated) released.erase(block);
  changes.released.assign(released.begin(), released.end());
  return changes;
}

}  // namespace depth_fusion
