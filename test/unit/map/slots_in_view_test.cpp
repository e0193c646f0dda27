#include "map/slots_in_view.h"

#include <gtest/gtest.h>

#include <set>

#include "shared/types.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{64, 48, 60.0, 60.0, 31.5, 23.5};
constexpr double kBlock_m = 0.08;
constexpr double kMaxRange_m = 3.0;

MapParameters parameters() {
  MapParameters map;
  map.voxel_size_m = 0.01f;
  map.blocks_per_axis = 128;
  map.pool_mib = 4;
  return map;
}

// Blocks enough for two groups of slots, the first at `corner`.
std::vector<BlockIndex> blocksAt(const BlockIndex& corner) {
  std::vector<BlockIndex> blocks;
  for (int z = 0; z < 4; ++z) {
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 8; ++x) blocks.push_back(corner + BlockIndex(x, y, z));
    }
  }
  return blocks;
}

class SlotsInViewOfTwoPlaces : public testing::Test {
 protected:
  void SetUp() override {
    map_.allocate(blocksAt({-4, -2, 12}));
    map_.allocate(blocksAt({-4, -2, -18}));
  }

  // Of the camera at the origin, turned about y.
  std::set<int> groupsSeen(double turn_rad, double max_range_m = kMaxRange_m) {
    const Pose T_D_W(Eigen::AngleAxisd(-turn_rad, Eigen::Vector3d::UnitY()));
    in_view_.list(map_, kCamera, T_D_W, max_range_m);
    EXPECT_EQ(in_view_.slots(), static_cast<size_t>(in_view_.groupCount()) * SLOTS_PER_GROUP);
    const std::vector<int> groups = in_view_.groups().read<int>(in_view_.groupCount());
    return {groups.begin(), groups.end()};
  }

  BlockMap map_{compute(), parameters()};
  SlotsInView in_view_{compute(), map_};
};

TEST_F(SlotsInViewOfTwoPlaces, AreThoseAheadOfTheCamera) {
  EXPECT_EQ(groupsSeen(0.0), (std::set<int>{0, 1}));
  EXPECT_EQ(groupsSeen(M_PI), (std::set<int>{2, 3}));
  EXPECT_EQ(groupsSeen(0.5 * M_PI), std::set<int>());
  EXPECT_EQ(groupsSeen(0.0, 11.0 * kBlock_m), std::set<int>());
}

// A view that turns sees a group for as long as some block of it is in the image.
TEST_F(SlotsInViewOfTwoPlaces, AreAllThatHoldABlockInTheImage) {
  for (double turn_rad = -M_PI; turn_rad < M_PI; turn_rad += 0.05) {
    const std::set<int> seen = groupsSeen(turn_rad);
    const Eigen::AngleAxisd to_D(-turn_rad, Eigen::Vector3d::UnitY());
    for (const SlotTable::Block& block : map_.slots().blocks()) {
      const Eigen::Vector3d p_D = to_D * (kBlock_m * (block.index.cast<double>().array() + 0.5).matrix());
      const double u = kCamera.fx * p_D.x() / p_D.z() + kCamera.cx,
                   v = kCamera.fy * p_D.y() / p_D.z() + kCamera.cy;
      const bool in_image = p_D.z() > 0.0 && u >= 0.0 && v >= 0.0 && u < kCamera.width && v < kCamera.height;
      if (!in_image) continue;
      ASSERT_TRUE(seen.count(block.slot / SLOTS_PER_GROUP)) << turn_rad;
    }
  }
}

TEST_F(SlotsInViewOfTwoPlaces, FollowBlocksThatComeAndGo) {
  std::vector<int> ahead;
  for (const SlotTable::Block& block : map_.slots().blocks()) {
    if (block.index.z() > 0) ahead.push_back(block.slot);
  }
  map_.release(ahead);
  EXPECT_EQ(groupsSeen(0.0), std::set<int>());
  map_.allocate(blocksAt({20, -2, -2}));
  EXPECT_EQ(groupsSeen(0.0), std::set<int>());
  EXPECT_EQ(groupsSeen(0.5 * M_PI), (std::set<int>{0, 1}));
  const std::unique_ptr<BlockMap> copy = map_.snapshot({kTsdfLayer});
  EXPECT_EQ(copy->slots().groupBoxes().size(), map_.slots().groupBoxes().size());
  map_.reset(Eigen::Vector3d::Zero());
  EXPECT_EQ(groupsSeen(M_PI), std::set<int>());
}

}  // namespace
}  // namespace depth_fusion
