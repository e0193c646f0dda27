#include "depth_fusion/submaps/submap_collection.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <string>
#include <thread>

#include "depth_fusion/submaps/map_file.h"
#include "shared/types.h"
#include "support/postgres_server.h"
#include "support/submap_walk.h"
#include "support/temporary_folder.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

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

// Most of what the window leaves is in the store before it moves.
TEST(SubmapCollection, WhatTheWindowWillLeaveIsStoredAhead) {
  Walk walk(windowOf(32), smallMemory());
  size_t ahead = 0, with_moves = 0;
  for (double x = 0.0; x < 12.0; x += 0.02) {
    const BlockIndex origin = walk.map().window().origin;
    const size_t before = walk.submaps().usage().blocks_put;
    walk.goTo(x);
    const bool has_moved = walk.map().window().origin != origin;
    (has_moved ? with_moves : ahead) += walk.submaps().usage().blocks_put - before;
  }
  EXPECT_GT(ahead, 4 * with_moves);
}

// A part of a group that cannot be read back keeps the group's other part in the pool, and nothing is lost.
TEST(SubmapCollection, NothingIsLostWhileTheStoreCannotBeRead) {
  if (PostgresServer::programs().empty()) GTEST_SKIP() << "no PostgreSQL server here";
  PostgresServer server;
  SubmapParameters parameters = smallMemory();
  parameters.store = server.uri("scratch");
  Walk walk(windowOf(35), parameters);
  for (double x = 0.0; x < 60.0; x += 0.05) walk.goTo(x);
  for (int i = 0; i < 600 && walk.submaps().usage().groups_on_disk == 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  ASSERT_GT(walk.submaps().usage().groups_on_disk, 0u);
  server.stop();
  std::set<std::string> problems;
  for (double x = 60.0; x > 0.0; x -= 0.05) {
    walk.look(x, true);
    problems.insert(walk.submaps().problem());
  }
  for (double x = 0.0; x < 30.0; x += 0.05) walk.look(x);
  EXPECT_GT(problems.size(), 1u);
  server.start();
  for (int i = 0; i < 600 && !walk.submaps().usage().problem.empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  walk.look(30.0);
  walk.expectAll();
}

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

// Each time a noisy sensor comes by, it strews blocks about surfaces that are far.
TEST(SubmapCollection, WhatNothingHasMadeSureIsForgotten) {
  Walk walk(windowOf(32), smallMemory());
  walk.goTo(0.0);
  std::vector<int> unsure;
  for (const SlotTable::Block& block : walk.map().slots().blocks()) {
    if (block.slot % 2 == 0) continue;
    unsure.push_back(block.slot);
    walk.expected().erase(block.index);
  }
  ASSERT_GT(unsure.size(), 5u);
  walk.map().setStates(unsure, std::vector<int>(unsure.size(), BLOCK_HAS_DATA));
  walk.look(6.0);
  EXPECT_EQ(walk.map().slots().used(), 0u);
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
    submaps.show(kWalkCamera, T_W_D, kWalkRange_m);
  };
  goTo(0.0);
  map.setStates(map.insert({{0, 0, 0}}), {BLOCK_HAS_DATA | BLOCK_SURE});
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

// Also where poses count as exact: what was mapped before another part began is kept, and not seen from it,
// in a map that was saved and loaded, too.
TEST(SubmapCollection, AnotherPartDoesNotSeeTheOneBefore) {
  SubmapParameters parameters = smallMemory();
  parameters.drift = 0.0f;
  Walk walk(windowOf(32), parameters);
  for (double x = 0.0; x < 3.0; x += 0.05) walk.goTo(x);
  const size_t before = walk.submaps().blockCount();
  ASSERT_TRUE(walk.submaps().beginPart());
  EXPECT_EQ(walk.map().slots().used(), 0u);
  EXPECT_EQ(walk.submaps().blockCount(), before);
  for (double x = 3.0; x > 0.0; x -= 0.05) walk.look(x);
  EXPECT_EQ(walk.map().slots().used(), 0u) << "nothing comes back";
  const TemporaryFolder folder;
  MapSaver saver(folder / "parts.map");
  walk.save(saver);
  BlockMap other(compute(), walk.map().parameters());
  SubmapCollection loaded(other, parameters);
  ReadMap(*openDatabase(folder / "parts.map", DatabaseAccess::kRead), loaded).moveTo(loaded);
  EXPECT_EQ(loaded.blockCount(), before);
  EXPECT_EQ(other.slots().used(), 0u);
  EXPECT_TRUE(Walk::contentsOf(loaded) == walk.expected());
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
  walk.save(saver);
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
  const SaveReport report = walk.save(saver);
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
  for (double x = 0.0; x < 4.0; x += 0.05) walk.goTo(x);
  EXPECT_EQ(walk.save(saver).blocks_written, walk.expected().size());
  EXPECT_EQ(walk.save(saver).blocks_written, 0u);
  for (double x = 4.0; x < 6.0; x += 0.05) walk.goTo(x);
  const SaveReport report = walk.save(saver);
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
  first.save(saver);
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
  EXPECT_TRUE(walk.submaps().isEmpty());
  walk.expected().clear();
  walk.goTo(0.0);
  EXPECT_EQ(walk.submaps().submaps().size(), 1u);
  walk.expectAll();
}

}  // namespace
}  // namespace depth_fusion
