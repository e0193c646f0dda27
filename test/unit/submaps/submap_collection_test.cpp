#include "depth_fusion/submaps/submap_collection.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "depth_fusion/submaps/map_file.h"
#include "submaps/whole_map.h"
#include "support/stored_maps.h"
#include "support/temporary_folder.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

const CameraIntrinsics kCamera{64, 48, 50.0, 50.0, 31.5, 23.5};
constexpr double kRange_m = 1.0;

using Contents = std::map<BlockIndex, std::string, BlockOrder>;

// A sensor that goes through a map and writes into what it sees, and what should be in the map.
class Walk {
 public:
  Walk(const MapParameters& map, const SubmapParameters& parameters)
      : map_(compute(), map), submaps_(map_, parameters), random_(3) {}

  // The sensor looks along x, or back, from there.
  void goTo(double x_m, double y_m = 0.0, bool back = false, bool is_given = true) {
    Pose T_W_D = Pose::Identity();
    T_W_D.linear() << 0, 0, back ? -1 : 1, -1, 0, 0, 0, back ? 1 : -1, 0;
    T_W_D.translation() << x_m, y_m, 0.0;
    submaps_.enter(T_W_D, is_given);
    submaps_.show(kCamera, T_W_D, kRange_m);
    write(T_W_D);
  }

  // All the blocks of the map, wherever they are; of the pool only those in view must be there.
  void expectAll() {
    TemporaryFolder folder;
    MapSaver saver(folder / "whole.map");
    saver.prepare();
    saver.capture(submaps_, describing(map_), {});
    const SaveReport report = saver.write();
    EXPECT_EQ(report.blocks, expected_.size());
    EXPECT_EQ(submaps_.blockCount(), expected_.size());
    BlockMap other(compute(), map_.parameters());
    SubmapCollection loaded(other, {});
    const auto database = openDatabase(folder / "whole.map", DatabaseAccess::kRead);
    ReadMap(*database, loaded).moveTo(loaded);
    EXPECT_TRUE(contentsOf(loaded) == expected_);
    EXPECT_TRUE(contentsOf(submaps_) == expected_);
  }

  BlockMap& map() { return map_; }
  SubmapCollection& submaps() { return submaps_; }
  Contents& expected() { return expected_; }
  // Wherever they are.
  static Contents contentsOf(SubmapCollection& submaps) {
    WholeMap whole(submaps);
    Contents contents;
    for (const auto& [index, counts] : whole.groups()) {
      const BlockGroup group = whole.groupOfWorld(index).front();
      for (size_t i = 0; i < group.blocks.size(); ++i)
        contents[group.blocks[i]] = group.voxels.substr(1024 * i, 1024);
    }
    return contents;
  }
  static Contents contentsOf(BlockMap& map) {
    Contents contents;
    for (const SlotTable::Block& block : map.slots().blocks())
      contents[block.index] = map.voxels(kTsdfLayer, {block.slot});
    return contents;
  }

 private:
  // Changes some blocks of a wall in view, makes those that are not there, and takes some away.
  void write(const Pose& T_W_D) {
    const double block_m = 8.0 * static_cast<double>(map_.parameters().voxel_size_m);
    const Contents here = contentsOf(map_);
    for (const auto& [block, voxels] : here) ASSERT_TRUE(expected_.at(block) == voxels) << block.transpose();
    std::vector<BlockIndex> seen, wanted;
    for (double along = 0.3; along < 0.9; along += block_m) {
      for (double up = -0.1; up < 0.1; up += block_m) {
        const Eigen::Vector3d p_W = T_W_D * Eigen::Vector3d(0.15, up, along);
        seen.push_back((p_W / block_m).array().floor().cast<int>());
      }
    }
    std::sort(seen.begin(), seen.end(), before);
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    std::map<BlockIndex, int, BlockOrder> slots;
    for (const SlotTable::Block& block : map_.slots().blocks()) slots[block.index] = block.slot;
    for (const BlockIndex& block : seen) {
      // What there was must be back before it is seen.
      ASSERT_EQ(slots.count(block), expected_.count(block)) << block.transpose();
      if (slots.count(block) == 0) wanted.push_back(block);
    }
    ASSERT_EQ(map_.allocate(wanted), wanted.size());
    std::vector<int> changed, gone;
    std::string voxels;
    for (const SlotTable::Block& block : map_.slots().blocks()) {
      if (!std::binary_search(seen.begin(), seen.end(), block.index, before)) continue;
      if (slots.count(block.index) > 0 && random_() % 16 == 0) {
        gone.push_back(block.slot);
        expected_.erase(block.index);
        continue;
      }
      std::string content(1024, static_cast<char>(random_()));
      content[random_() % 1024] = 'x';
      expected_[block.index] = content;
      changed.push_back(block.slot);
      voxels += content;
    }
    map_.setVoxels(kTsdfLayer, changed, voxels);
    map_.noteUpdated(changed);
    map_.remove(gone);
  }

  BlockMap map_;
  SubmapCollection submaps_;
  Contents expected_;
  std::mt19937 random_;
};

MapParameters windowOf(int blocks_per_axis, int pool_mib = 1) {
  MapParameters parameters;
  parameters.voxel_size_m = 0.01f;
  parameters.blocks_per_axis = blocks_per_axis;
  parameters.pool_mib = pool_mib;
  return parameters;
}

SubmapParameters smallMemory() {
  SubmapParameters parameters;
  parameters.memory_mib = 1;
  return parameters;
}

// The window's edge is, and is not, one of groups of blocks.
class AnyWindow : public testing::TestWithParam<int> {};

TEST_P(AnyWindow, ALongWayComesBackBitForBit) {
  Walk walk(windowOf(GetParam()), smallMemory());
  for (double x = 0.0; x < 12.0; x += 0.05) walk.goTo(x);
  const size_t submaps = walk.submaps().submaps().size();
  EXPECT_GT(submaps, 3u);
  walk.expectAll();
  for (double x = 12.0; x > 0.0; x -= 0.05) walk.goTo(x, 0.0, true);
  walk.expectAll();
  EXPECT_EQ(walk.submaps().submaps().size(), submaps) << "those that are there are active again";
  EXPECT_LE(walk.map().slots().used(), 1024u);
}

INSTANTIATE_TEST_SUITE_P(Windows, AnyWindow, testing::Values(28, 32, 35));

TEST(SubmapCollection, LapsTakeTheMemoryOfOne) {
  Walk walk(windowOf(32), smallMemory());
  size_t blocks = 0, submaps = 0;
  for (int lap = 0; lap < 6; ++lap) {
    for (double x = 0.0; x < 6.0; x += 0.1) walk.goTo(x);
    for (double x = 6.0; x > 0.0; x -= 0.1) walk.goTo(x, 0.1, true);
    if (lap == 1) {
      blocks = walk.submaps().blockCount();
      submaps = walk.submaps().submaps().size();
    }
  }
  EXPECT_LE(walk.submaps().blockCount(), blocks + blocks / 20);
  EXPECT_EQ(walk.submaps().submaps().size(), submaps);
  walk.expectAll();
}

TEST(SubmapCollection, ARoomThatFitsIsOneSubmapAndNothingGoes) {
  Walk walk(windowOf(64), smallMemory());
  for (int i = 0; i < 100; ++i) walk.goTo(0.5 * std::sin(0.1 * i), 0.3 * std::cos(0.13 * i), i % 2 == 0);
  EXPECT_EQ(walk.submaps().submaps().size(), 1u);
  EXPECT_EQ(walk.submaps().usage().blocks_put, 0u);
  EXPECT_TRUE(Walk::contentsOf(walk.map()) == walk.expected());
}

// The window would hold all; the pool does not.
TEST(SubmapCollection, AFullPoolGivesUpWhatIsFarAndBringsItBack) {
  MapParameters parameters = windowOf(128);
  parameters.voxel_size_m = 0.003f;
  Walk walk(parameters, smallMemory());
  for (int round = 0; round < 3; ++round) {
    for (double x = 0.0; x < 1.0; x += 0.05) walk.goTo(x, 0.2 * round);
    for (double x = 1.0; x > 0.0; x -= 0.05) walk.goTo(x, 0.2 * round, true);
  }
  EXPECT_EQ(walk.submaps().submaps().size(), 1u);
  EXPECT_GT(walk.submaps().usage().blocks_put, 0u);
  EXPECT_GT(walk.submaps().blockCount(), walk.map().slots().capacity());
  EXPECT_EQ(walk.submaps().problem(), "");
  walk.expectAll();
}

// After a long way by tracked poses, a submap's place is not sure any more: it is left as it is.
TEST(SubmapCollection, WhatIsNotSureIsNotGoneOnWith) {
  SubmapParameters parameters = smallMemory();
  parameters.drift = 0.01f;
  parameters.sure_m = 0.05f;
  BlockMap map(compute(), windowOf(32));
  SubmapCollection submaps(map, parameters);
  const auto goTo = [&](double x) {
    Pose T_W_D = Pose::Identity();
    T_W_D.translation().x() = x;
    submaps.enter(T_W_D, false);
    submaps.show(kCamera, T_W_D, kRange_m);
  };
  goTo(0.0);
  map.insert({{0, 0, 0}});
  for (double x = 0.1; x < 1.5; x += 0.1) goTo(x);
  EXPECT_EQ(submaps.active(), 1u);
  for (double x = 1.5; x > -0.3; x -= 0.1) goTo(x);
  EXPECT_EQ(submaps.active(), 0u) << "3 m are 3 cm";
  for (double x = -0.3; x < 5.0; x += 0.1) goTo(x);
  for (double x = 5.0; x > -0.3; x -= 0.1) goTo(x);
  EXPECT_GT(submaps.active(), 1u) << "10 m are 10 cm";
  EXPECT_EQ(map.slots().used(), 0u) << "the block of the first one is not brought back";
  EXPECT_EQ(submaps.blockCount(), 1u);
}

TEST(SubmapCollection, ASubmapEndsAfterALengthThatIsSaid) {
  SubmapParameters parameters = smallMemory();
  parameters.max_length_m = 1.0f;
  Walk walk(windowOf(64), parameters);
  for (double x = 0.0; x < 1.5; x += 0.05) walk.goTo(x * 0.2 + (static_cast<int>(x * 20) % 2) * 0.2);
  EXPECT_GT(walk.submaps().submaps().size(), 2u);
  walk.expectAll();
}

TEST(SubmapCollection, ARegionIsClearedInThePoolAndElsewhere) {
  Walk walk(windowOf(32), smallMemory());
  for (double x = 0.0; x < 6.0; x += 0.05) walk.goTo(x);
  TemporaryFolder folder;
  MapSaver saver(folder / "whole.map");
  const auto save = [&] {
    saver.prepare();
    saver.capture(walk.submaps(), describing(walk.map()), {});
    return saver.write();
  };
  save();
  const Eigen::AlignedBox3d box(Eigen::Vector3d(2.003, -5.0, -5.0), Eigen::Vector3d(6.0, 5.0, 5.0));
  const size_t met = walk.submaps().clear(box, [&](const Eigen::Vector3d& p) { return box.contains(p); });
  EXPECT_GT(met, 100u);
  size_t cut = 0;
  for (auto entry = walk.expected().begin(); entry != walk.expected().end();) {
    const auto isInside = [&](int x) {
      return box.contains(Eigen::Vector3d(0.01 * (8 * entry->first.x() + x), 0, 0));
    };
    const bool all = isInside(0) && isInside(7), none = !isInside(0) && !isInside(7);
    std::string& voxels = entry->second;
    for (int v = 0; v < 512 && !all && !none; ++v) {
      if (!isInside(v % 8)) continue;
      voxels[v] = static_cast<char>(-128);
      voxels[512 + v] = 0;
    }
    cut += !all && !none;
    entry = all ? walk.expected().erase(entry) : std::next(entry);
  }
  EXPECT_GT(cut, 0u);
  walk.expectAll();
  // A save writes what was cleared, wherever it is.
  const SaveReport report = save();
  EXPECT_EQ(report.blocks, walk.expected().size());
  BlockMap other(compute(), walk.map().parameters());
  SubmapCollection loaded(other, {});
  ReadMap(*openDatabase(folder / "whole.map", DatabaseAccess::kRead), loaded).moveTo(loaded);
  EXPECT_TRUE(Walk::contentsOf(loaded) == walk.expected());
}

// Saves write what changed, also of what has left the pool, and no more.
TEST(SubmapCollection, LaterSavesWriteWhatHasChanged) {
  Walk walk(windowOf(32), smallMemory());
  TemporaryFolder folder;
  MapSaver saver(folder / "whole.map");
  const auto save = [&] {
    saver.prepare();
    saver.capture(walk.submaps(), describing(walk.map()), {});
    return saver.write();
  };
  for (double x = 0.0; x < 4.0; x += 0.05) walk.goTo(x);
  EXPECT_EQ(save().blocks_written, walk.expected().size());
  EXPECT_EQ(save().blocks_written, 0u);
  for (double x = 4.0; x < 6.0; x += 0.05) walk.goTo(x);
  const SaveReport report = save();
  EXPECT_GT(report.blocks_written, 0u);
  EXPECT_LT(report.blocks_written, report.blocks);
  BlockMap other(compute(), walk.map().parameters());
  SubmapCollection loaded(other, {});
  ReadMap(*openDatabase(folder / "whole.map", DatabaseAccess::kRead), loaded).moveTo(loaded);
  EXPECT_EQ(loaded.submaps().size(), walk.submaps().submaps().size());
  EXPECT_TRUE(Walk::contentsOf(loaded) == walk.expected());
}

// A map that is larger than window and pool is loaded, and comes back where it is seen.
TEST(SubmapCollection, ALoadedMapIsPagedAsItWas) {
  TemporaryFolder folder;
  Walk first(windowOf(32), smallMemory());
  for (double x = 0.0; x < 6.0; x += 0.05) first.goTo(x);
  MapSaver saver(folder / "whole.map");
  saver.prepare();
  saver.capture(first.submaps(), describing(first.map()), {});
  saver.write();
  Walk second(windowOf(32), smallMemory());
  const auto database = openDatabase(folder / "whole.map", DatabaseAccess::kRead);
  ReadMap read(*database, second.submaps());
  read.moveTo(second.submaps());
  second.expected() = first.expected();
  second.expectAll();
  for (double x = 6.0; x > 0.0; x -= 0.05) second.goTo(x, 0.0, true);
  second.expectAll();
}

TEST(SubmapCollection, AResetForgetsAll) {
  Walk walk(windowOf(32), smallMemory());
  for (double x = 0.0; x < 4.0; x += 0.05) walk.goTo(x);
  walk.map().reset(Eigen::Vector3d::Zero());
  walk.expected().clear();
  walk.goTo(0.0);
  EXPECT_EQ(walk.submaps().submaps().size(), 1u);
  walk.expectAll();
}

}  // namespace
}  // namespace depth_fusion
