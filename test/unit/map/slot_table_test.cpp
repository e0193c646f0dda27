#include "depth_fusion/map/slot_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

#include "depth_fusion/common/error.h"
#include "shared/types.h"

namespace depth_fusion {
namespace {

std::vector<BlockIndex> blocksFrom(int first, int count) {
  std::vector<BlockIndex> blocks;
  for (int i = first; i < first + count; ++i) blocks.emplace_back(i, -i, 2 * i);
  return blocks;
}

// The table is what its slots say one by one.
void expectConsistent(const SlotTable& table) {
  size_t used = 0;
  std::vector<BlockBox> boxes((static_cast<size_t>(table.bound()) + SLOTS_PER_GROUP - 1) / SLOTS_PER_GROUP);
  for (int slot = 0; slot < table.bound(); ++slot) {
    if (!table.inUse(slot)) continue;
    ++used;
    boxes[static_cast<size_t>(slot) / SLOTS_PER_GROUP].extend(table.blockOf(slot));
  }
  EXPECT_EQ(table.used(), used);
  EXPECT_EQ(table.free(), table.capacity() - used);
  EXPECT_EQ(table.blocks().size(), used);
  ASSERT_EQ(table.groupBoxes().size(), boxes.size());
  for (size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_EQ(table.groupBoxes()[i].isEmpty(), boxes[i].isEmpty()) << i;
    EXPECT_TRUE(boxes[i].isEmpty() || table.groupBoxes()[i].isApprox(boxes[i])) << i;
  }
}

TEST(SlotTable, GivesNoSlotTwice) {
  SlotTable table(200);
  std::set<int> given;
  for (int first = 0; first < 200; first += 50) {
    const std::vector<int> slots = table.take(blocksFrom(first, 50));
    ASSERT_EQ(slots.size(), 50u);
    for (const int slot : slots) EXPECT_TRUE(given.insert(slot).second) << slot;
    expectConsistent(table);
  }
  EXPECT_EQ(*given.begin(), 0);
  EXPECT_EQ(*given.rbegin(), 199);
  EXPECT_TRUE(table.take(blocksFrom(200, 3)).empty());
}

TEST(SlotTable, ServesTheFirstBlocksWhenItIsNearlyFull) {
  SlotTable table(5);
  const std::vector<BlockIndex> blocks = blocksFrom(0, 8);
  const std::vector<int> slots = table.take(blocks);
  ASSERT_EQ(slots.size(), 5u);
  for (size_t i = 0; i < slots.size(); ++i) EXPECT_EQ(table.blockOf(slots[i]), blocks[i]);
}

TEST(SlotTable, ReleasedSlotsComeAgain) {
  SlotTable table(100);
  std::vector<int> slots = table.take(blocksFrom(0, 100));
  std::shuffle(slots.begin(), slots.end(), std::mt19937(1));
  const std::vector<int> released(slots.begin(), slots.begin() + 30);
  table.release(released);
  expectConsistent(table);
  const std::vector<int> again = table.take(blocksFrom(500, 40));
  EXPECT_EQ(std::set<int>(again.begin(), again.end()), std::set<int>(released.begin(), released.end()));
  EXPECT_TRUE(std::equal(released.begin(), released.end(), again.begin())) << "in their order";
  EXPECT_EQ(table.bound(), 100);
  expectConsistent(table);
}

TEST(SlotTable, AReleasedSlotStillTellsItsBlock) {
  SlotTable table(3);
  const int slot = table.take({BlockIndex(7, 8, 9)}).front();
  table.release({slot});
  EXPECT_FALSE(table.inUse(slot));
  EXPECT_EQ(table.blockOf(slot), BlockIndex(7, 8, 9));
  EXPECT_TRUE(table.groupBoxes().front().isEmpty());
}

TEST(SlotTable, RefusesToReleaseWhatIsNotInUse) {
  SlotTable table(4);
  const int slot = table.take(blocksFrom(0, 1)).front();
  for (const int wrong : {slot + 1, -1}) EXPECT_THROW(table.release({wrong}), Error);
  table.release({slot});
  EXPECT_THROW(table.release({slot}), Error);
  EXPECT_EQ(table.free(), 4u);
}

TEST(SlotTable, BoxesFollowAnyHistory) {
  SlotTable table(3 * SLOTS_PER_GROUP - 7);
  std::mt19937 random(2);
  for (int round = 0; round < 50; ++round) {
    table.take(blocksFrom(10 * round, static_cast<int>(random() % 40)));
    std::vector<int> released;
    for (int slot = 0; slot < table.bound(); ++slot) {
      if (table.inUse(slot) && random() % 3 == 0) released.push_back(slot);
    }
    table.release(released);
    expectConsistent(table);
  }
}

TEST(SlotTable, TrimmedHasTheSameBlocksAndNoRoomBeyondThem) {
  SlotTable table(100);
  const std::vector<int> slots = table.take(blocksFrom(0, 10));
  table.release({slots[3], slots[6]});
  SlotTable trimmed = table.trimmed();
  EXPECT_EQ(trimmed.capacity(), 10u);
  expectConsistent(trimmed);
  EXPECT_EQ(trimmed.take(blocksFrom(50, 5)).size(), 2u);
  EXPECT_EQ(SlotTable(8).trimmed().capacity(), 1u);
}

TEST(SlotTable, ClearForgetsAll) {
  SlotTable table(6);
  table.take(blocksFrom(0, 6));
  table.clear();
  EXPECT_EQ(table.bound(), 0);
  EXPECT_EQ(table.take(blocksFrom(0, 6)), (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace depth_fusion
