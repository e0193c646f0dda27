// A map, and a file that it is saved in.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "shared/types.h"
#include "support/stored_maps.h"
#include "support/temporary_folder.h"
#include "support/test_compute.h"

namespace depth_fusion {

class MapFile : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string path_ = folder_ / "ball.map";
  BlockMap map_{compute(), smallMap()};
  ChangingMap changing_{compute(), map_};
};

// Everything that a map is told by, its states included; a block that was kept is kept on.
inline void expectSame(BlockMap& a, BlockMap& b) {
  EXPECT_TRUE(readMap(a) == readMap(b));
  std::map<BlockKey, int> states[2];
  for (int i = 0; i < 2; ++i) {
    BlockMap& map = i == 0 ? a : b;
    const std::vector<int> of_slots = map.blockStates().read<int>(map.slots().bound());
    const std::vector<int> offsets = map.offsets().read<int>(map.window().blockCount());
    for (const SlotTable::Block& block : map.slots().blocks()) {
      states[i][keyOf(block.index)] = of_slots[block.slot] | BLOCK_SURE;
      EXPECT_EQ(offsets[map.window().address(block.index)], block.slot);
    }
  }
  EXPECT_EQ(states[0], states[1]);
}

}  // namespace depth_fusion
