#include "depth_fusion/map/map_changes.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <set>

namespace depth_fusion {
namespace {

struct InOrder {
  bool operator()(const BlockIndex& a, const BlockIndex& b) const { return before(a, b); }
};
using Blocks = std::set<BlockIndex, InOrder>;

BlockIndex block(int i) { return {i, 2 * i, -i}; }

Blocks setOf(const std::vector<BlockIndex>& blocks) { return {blocks.begin(), blocks.end()}; }

// A map without contents: blocks come, change and go.
class MapOfBlocks {
 public:
  explicit MapOfBlocks(size_t max_released = 1000) : slots(500), log(slots, max_released) {}

  void allocate(int first, int count) {
    std::vector<BlockIndex> blocks;
    for (int i = first; i < first + count; ++i) blocks.push_back(block(i));
    log.noteUpdated(slots.take(blocks));
  }
  void update(int i) { log.noteUpdated({slotOf(i)}); }
  void release(int i) {
    const int slot = slotOf(i);
    slots.release({slot});
    log.noteReleased({slot});
  }
  void evict(int i) {
    const int slot = slotOf(i);
    slots.release({slot});
    log.noteEvicted({slot});
  }
  void bringBack(int i) { log.noteReturned(slots.take({block(i)})); }
  void reset() {
    slots.clear();
    log.noteReset();
  }
  Blocks blocks() const {
    Blocks found;
    for (const SlotTable::Block& b : slots.blocks()) found.insert(b.index);
    return found;
  }
  int slotOf(int i) const {
    for (int slot = 0; slot < slots.bound(); ++slot) {
      if (slots.inUse(slot) && slots.blockOf(slot) == block(i)) return slot;
    }
    return -1;
  }

  SlotTable slots;
  ChangeLog log;
};

// What a follower knows that does as it is told.
struct Copy {
  Blocks blocks;

  void follow(const MapChanges& changes) {
    if (changes.complete) blocks.clear();
    for (const BlockIndex& b : changes.updated) blocks.insert(b);
    for (const BlockIndex& b : changes.released) blocks.erase(b);
  }
};

TEST(MapChanges, AreToldOnceAndAsWhatTheBlocksAreByNow) {
  MapOfBlocks map;
  MapSubscription follower = map.log.subscribe();
  follower.take();
  map.allocate(0, 4);
  map.update(1);
  map.update(1);
  map.release(2);
  const MapChanges changes = follower.take();
  EXPECT_FALSE(changes.complete);
  EXPECT_EQ(changes.generation, map.log.generation());
  EXPECT_EQ(changes.updated, (std::vector<BlockIndex>{block(0), block(3), block(1)}));  // the oldest first
  EXPECT_EQ(changes.released, (std::vector<BlockIndex>{block(2)}));
  const MapChanges none = follower.take();
  EXPECT_TRUE(none.updated.empty() && none.released.empty() && !none.complete);
}

TEST(MapChanges, OfABlockThatComesAgainAreAnUpdate) {
  MapOfBlocks map;
  map.allocate(0, 3);
  MapSubscription follower = map.log.subscribe();
  follower.take();
  map.release(1);
  map.allocate(1, 1);
  MapChanges changes = follower.take();
  EXPECT_EQ(changes.updated, (std::vector<BlockIndex>{block(1)}));
  EXPECT_TRUE(changes.released.empty());
  map.release(1);
  map.allocate(7, 1);  // in the same slot
  changes = follower.take();
  EXPECT_EQ(changes.updated, (std::vector<BlockIndex>{block(7)}));
  EXPECT_EQ(changes.released, (std::vector<BlockIndex>{block(1)}));
}

TEST(MapChanges, PassOverSlotsThatWereReleased) {
  MapOfBlocks map;
  map.allocate(0, 2);
  MapSubscription follower = map.log.subscribe();
  follower.take();
  const int slot = map.slotOf(0);
  map.release(0);
  map.log.noteUpdated({slot});
  const MapChanges changes = follower.take();
  EXPECT_TRUE(changes.updated.empty());
  EXPECT_EQ(changes.released, (std::vector<BlockIndex>{block(0)}));
}

TEST(MapChanges, TellWhoComesLateOfEverything) {
  MapOfBlocks map;
  map.allocate(0, 20);
  MapSubscription first = map.log.subscribe();
  first.take();
  map.release(3);
  map.allocate(30, 2);
  MapSubscription late = map.log.subscribe();
  const MapChanges changes = late.take();
  EXPECT_TRUE(changes.complete);
  EXPECT_EQ(setOf(changes.updated), map.blocks());
  EXPECT_TRUE(changes.released.empty());
  EXPECT_EQ(first.take().released, (std::vector<BlockIndex>{block(3)}));
}

TEST(MapChanges, TellWhoHasMissedTooMuchOfEverythingOnce) {
  MapOfBlocks map(10);
  map.allocate(0, 100);
  MapSubscription slow = map.log.subscribe(), quick = map.log.subscribe();
  slow.take();
  quick.take();
  for (int i = 0; i < 11; ++i) {
    map.release(i);
    EXPECT_FALSE(quick.take().complete);
  }
  const MapChanges changes = slow.take();
  EXPECT_TRUE(changes.complete);
  EXPECT_EQ(setOf(changes.updated), map.blocks());
  map.update(50);
  const MapChanges after = slow.take();
  EXPECT_FALSE(after.complete);
  EXPECT_EQ(after.updated, (std::vector<BlockIndex>{block(50)}));
}

// What has left memory is told of if it had changed, and only then.
TEST(MapChanges, TellWhatChangedBeforeItWasEvicted) {
  MapOfBlocks map;
  map.allocate(0, 4);
  MapSubscription follower = map.log.subscribe();
  follower.take();
  map.update(1);
  map.evict(1);
  map.evict(2);
  MapChanges changes = follower.take();
  EXPECT_EQ(changes.evicted, (std::vector<BlockIndex>{block(1)}));
  EXPECT_TRUE(changes.updated.empty() && changes.released.empty());
  // It comes back as it was, which is no change, and goes again.
  map.bringBack(1);
  EXPECT_TRUE(follower.take().updated.empty());
  map.evict(1);
  changes = follower.take();
  EXPECT_TRUE(changes.evicted.empty() && changes.updated.empty());
  map.bringBack(1);
  map.update(1);
  map.release(1);
  EXPECT_EQ(follower.take().released, (std::vector<BlockIndex>{block(1)}));
  map.log.noteChangedElsewhere({block(2)});
  EXPECT_EQ(follower.take().evicted, (std::vector<BlockIndex>{block(2)}));
}

TEST(MapChanges, BeginAnewAfterAReset) {
  MapOfBlocks map;
  map.allocate(0, 5);
  MapSubscription follower = map.log.subscribe();
  const uint32_t generation = follower.take().generation;
  map.release(4);
  map.reset();
  map.allocate(8, 2);
  const MapChanges changes = follower.take();
  EXPECT_NE(changes.generation, generation);
  EXPECT_TRUE(changes.complete);
  EXPECT_EQ(setOf(changes.updated), map.blocks());
  EXPECT_TRUE(changes.released.empty());
  EXPECT_NE(MapOfBlocks().log.generation(), changes.generation);  // nor is it another map's
}

// What was released before a reset makes no room after it, and hides it from nobody.
TEST(MapChanges, TellOfAResetHoweverMuchIsReleasedAfterIt) {
  MapOfBlocks map(2);
  map.allocate(0, 5);
  MapSubscription follower = map.log.subscribe();
  map.release(0);
  map.release(1);
  follower.take();
  map.reset();
  map.allocate(8, 3);
  map.release(8);
  const MapChanges changes = follower.take();
  EXPECT_TRUE(changes.complete);
  EXPECT_EQ(setOf(changes.updated), map.blocks());
}

TEST(MapChanges, NobodyIsFollowedByWhoWentAway) {
  MapOfBlocks map;
  EXPECT_FALSE(map.log.isFollowed());
  auto follower = std::make_unique<MapSubscription>(map.log.subscribe());
  auto other = std::make_unique<MapSubscription>(map.log.subscribe());
  follower.reset();
  EXPECT_TRUE(map.log.isFollowed());
  other.reset();
  EXPECT_FALSE(map.log.isFollowed());
}

TEST(MapChanges, WhatNobodyWasToldIsToldToTheNext) {
  MapOfBlocks map;
  map.allocate(0, 3);
  { map.log.subscribe().take(); }
  EXPECT_FALSE(map.log.isFollowed());
  map.release(0);
  map.allocate(9, 1);
  Copy copy;
  copy.follow(map.log.subscribe().take());
  EXPECT_EQ(copy.blocks, map.blocks());
}

TEST(MapChanges, GiveEveryFollowerTheMap) {
  MapOfBlocks map(20);
  MapSubscription subscriptions[3] = {map.log.subscribe(), map.log.subscribe(), map.log.subscribe()};
  Copy copies[3];
  std::mt19937 random(3);
  for (int round = 1; round <= 600; ++round) {
    const int i = static_cast<int>(random() % 60);
    if (map.slotOf(i) < 0) {
      map.allocate(i, 1);
    } else if (random() % 2 == 0) {
      map.release(i);
    } else {
      map.update(i);
    }
    if (random() % 200 == 0) map.reset();
    const int pauses[3] = {1, 7, 150};
    for (int f = 0; f < 3; ++f) {
      if (round % pauses[f] != 0) continue;
      copies[f].follow(subscriptions[f].take());
      ASSERT_EQ(copies[f].blocks, map.blocks()) << "follower " << f << ", round " << round;
    }
  }
}

}  // namespace
}  // namespace depth_fusion
