// What whoever follows a map is told of it.
//
// Nothing here is synchronised: whoever changes the map, subscribes or takes changes holds what guards the
// map (live, SharedMap's lock). Only letting go of a subscription is free to happen at any time.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "depth_fusion/map/slot_table.h"

namespace depth_fusion {

// What became of the map since its follower asked last. A block is told once, as what it is by now.
struct MapChanges {
  uint32_t generation = 0;  // another one after every reset, and of every map of the process; never 0
  // `updated` has all the blocks of the map, and whatever else the follower knows of is gone. So it is for a
  // follower that asks for the first time, after a reset, and when it has missed too much.
  bool complete = false;
  std::vector<BlockIndex> updated;   // blocks with other contents, the oldest change first
  std::vector<BlockIndex> released;  // blocks that are no longer in the map
  std::vector<BlockIndex> evicted;   // blocks that changed, and have left memory since, for a store
};

class ChangeLog;

// A follower's place in a map's log. It must not outlive the map but to be destroyed.
class MapSubscription {
 public:
  // The changes since the last call; everything the first time.
  MapChanges take();

 private:
  friend class ChangeLog;
  MapSubscription(const ChangeLog& log, std::shared_ptr<const void> follower)
      : log_(&log), follower_(std::move(follower)) {}

  const ChangeLog* log_;
  std::shared_ptr<const void> follower_;
  uint64_t seen_ = 0;  // the step that the follower was told of last
};

// Records the changes of a map as long as somebody follows it, at the cost of a number a slot and of a
// bounded list, however many followers there are and however slow they are.
class ChangeLog {
 public:
  // Keeps a reference to the slots. A follower that has missed more than max_departed blocks that were
  // released or evicted is told of everything.
  explicit ChangeLog(const SlotTable& slots, size_t max_departed = 262144);

  MapSubscription subscribe();
  // Whether somebody holds a subscription. If nobody does, the notes below cost nothing.
  bool isFollowed() const { return followers_.use_count() > 1; }

  // The blocks in these slots have other contents; slots that are not in use are passed over.
  void noteUpdated(const std::vector<int>& slots);
  // The blocks that these slots held are gone; told before the slots are given away again.
  void noteReleased(const std::vector<int>& slots);
  // The blocks that these slots held are kept elsewhere, as they are; told before the slots are given away
  // again.
  void noteEvicted(const std::vector<int>& slots);
  // These blocks, which are kept elsewhere, have other contents.
  void noteChangedElsewhere(const std::vector<BlockIndex>& blocks);
  // The blocks in these slots are back from there, as they were.
  void noteReturned(const std::vector<int>& slots);
  // The map was emptied: a new generation begins.
  void noteReset();

  uint32_t generation() const { return generation_; }

 private:
  friend class MapSubscription;
  // A block has left its slot.
  struct Departure {
    uint64_t step;
    BlockIndex block;
    bool evicted;
    uint64_t updated_at;
  };

  // Begins a step; false if nobody is there to be told of it.
  bool beginStep();
  void noteDeparted(const std::vector<int>& slots, bool evicted);
  void noteDeparture(const Departure& departure);
  void forgetOldest();
  uint64_t updatedAt(int slot) const;
  MapChanges changesSince(uint64_t step) const;

  const SlotTable& slots_;
  size_t max_departed_;
  uint32_t generation_;
  std::shared_ptr<const void> followers_;  // each subscription has a copy
  uint64_t step_ = 1;                      // counts the notes
  uint64_t complete_from_ = 1;             // who was told of less than this step is told of everything
  std::vector<uint64_t> updated_at_;       // the step of a slot's last update
  std::deque<Departure> departed_;
};

}  // namespace depth_fusion
