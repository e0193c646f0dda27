#include "depth_fusion/map/window.h"

#include <gtest/gtest.h>

#include <set>

namespace depth_fusion {
namespace {

TEST(Window, HasThePointInItsMiddleBlock) {
  const Window window = Window::centredOn({0.81, -0.01, -7.99}, 0.08, 10);
  EXPECT_EQ(window.origin, BlockIndex(10 - 5, -1 - 5, -100 - 5));
}

TEST(Window, ContainsItsBlocksAndNoOthers) {
  const Window window{BlockIndex(-3, 5, 0), 4};
  EXPECT_EQ(window.blockCount(), 64u);
  for (const BlockIndex& inside : {BlockIndex(-3, 5, 0), BlockIndex(0, 8, 3)})
    EXPECT_TRUE(window.contains(inside)) << inside.transpose();
  for (const BlockIndex& outside : {BlockIndex(-4, 5, 0), BlockIndex(1, 5, 0), BlockIndex(-3, 9, 0)})
    EXPECT_FALSE(window.contains(outside)) << outside.transpose();
}

TEST(Window, GivesEachBlockAnAddressOfItsOwnWhereverItStands) {
  for (const int origin : {0, -1, 7, -1000}) {
    const Window window{BlockIndex(origin, 2 * origin, -origin), 5};
    std::set<size_t> addresses;
    for (int i = 0; i < 125; ++i)
      addresses.insert(window.address(window.origin + BlockIndex(i % 5, i / 5 % 5, i / 25)));
    EXPECT_EQ(addresses.size(), 125u);
    EXPECT_LT(*addresses.rbegin(), 125u);
  }
}

TEST(Window, LeavesTheAddressesOfBlocksThatStayInItWhenItMoves) {
  const Window before{BlockIndex(0, 0, 0), 6}, after{BlockIndex(2, -1, 3), 6};
  for (const BlockIndex& block : {BlockIndex(2, 0, 3), BlockIndex(5, 4, 5)}) {
    ASSERT_TRUE(before.contains(block) && after.contains(block));
    EXPECT_EQ(before.address(block), after.address(block));
  }
}

}  // namespace
}  // namespace depth_fusion
