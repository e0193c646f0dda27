#include "depth_fusion/submaps/map_check.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <random>

#include "submaps/row_keys.h"
#include "support/expect_error.h"
#include "support/file_bytes.h"
#include "support/stored_maps.h"
#include "support/temporary_folder.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

MapParameters coloredMap() {
  MapParameters parameters = smallMap();
  parameters.color = true;
  return parameters;
}

class MapCheckTest : public testing::Test {
 protected:
  MapCheckTest() {
    ChangingMap(compute(), map_).show(sphere({0.0, 0.0, 0.0}, 0.19));
    std::vector<uint32_t> colors(512 * map_.slots().bound());
    std::mt19937 random(1);
    for (uint32_t& color : colors) color = static_cast<uint32_t>(random());
    map_.layer(kColorLayer).write(colors);
    MapSaver saver(path_);
    save(saver, map_, {someKeyframe(1.0), someKeyframe(2.0)});
  }

  MapCheck check(const std::string& path) { return checkMap(*openDatabase(path, DatabaseAccess::kRead)); }
  // A row of that prefix with a byte changed.
  void damageRow(const std::string& prefix) {
    const auto database = openDatabase(path_, DatabaseAccess::kWrite);
    std::string key, value;
    database->read()->forEach(prefix, [&](const auto& name, const auto& bytes) {
      key = name;
      value = bytes;
    });
    value[value.size() / 2] ^= 1;
    const auto writer = database->write();
    writer->put(key, value);
    writer->commit();
  }
  // Expects that what was rescued is a good map, and returns how many blocks it has.
  size_t expectGood(const std::string& path) {
    EXPECT_TRUE(check(path).problems.empty());
    BlockMap other(compute(), coloredMap());
    load(path, other);
    const MapContent whole = readMap(map_);
    for (const auto& [key, content] : readMap(other)) EXPECT_TRUE(whole.at(key) == content);
    return other.slots().used();
  }

  TemporaryFolder folder_;
  std::string path_ = folder_ / "ball.map", rescued_ = folder_ / "rescued.map";
  BlockMap map_{compute(), coloredMap()};
};

TEST_F(MapCheckTest, AGoodMapIsCounted) {
  const MapCheck found = check(path_);
  EXPECT_TRUE(found.problems.empty());
  EXPECT_EQ(found.blocks.at(kTsdfLayer), map_.slots().used());
  EXPECT_EQ(found.blocks.at(kColorLayer), map_.slots().used());
  EXPECT_GT(found.row_bytes.at(kColorLayer), 1000u * map_.slots().used());
  EXPECT_EQ(found.keyframes, 2u);
}

TEST_F(MapCheckTest, DamagedRowsAreNamedAndTheOthersRescued) {
  for (const std::string& prefix :
       {blocksPrefix(0, kTsdfLayer), blocksPrefix(0, kColorLayer), keyframePrefix(0)})
    damageRow(prefix);
  const MapCheck found = check(path_);
  EXPECT_GE(found.problems.size(), 3u);
  EXPECT_NE(found.problems.front().find("blocks/"), std::string::npos) << found.problems.front();
  EXPECT_EQ(found.keyframes, 1u);
  const MapRescue saved = rescueMap(path_, rescued_);
  EXPECT_EQ(saved.keyframes, 1u);
  EXPECT_GT(saved.blocks_lost, 0u);
  EXPECT_EQ(saved.blocks + saved.blocks_lost, map_.slots().used());
  EXPECT_EQ(expectGood(rescued_), saved.blocks);
}

TEST_F(MapCheckTest, AMapThatHasOtherBlocksThanItSaysIsFound) {
  const auto database = openDatabase(path_, DatabaseAccess::kWrite);
  std::string key;
  database->read()->forEach(blocksPrefix(0, kTsdfLayer), [&](const auto& name, const auto&) { key = name; });
  const auto writer = database->write();
  writer->erase(key);
  writer->commit();
  EXPECT_FALSE(checkMap(*database).problems.empty());
}

// Pages of the file are overwritten, or it is cut: LMDB itself may not even open it.
TEST_F(MapCheckTest, WhatCanBeReadOfADamagedFileIsRescued) {
  const std::string whole = fileBytes(path_), damaged = folder_ / "damaged.map";
  constexpr size_t kPage = 4096;
  std::mt19937 random(2);
  int rescued = 0, lost_some = 0;
  for (int i = 0; i < 25; ++i) {
    std::string bytes = whole;
    if (i % 5 == 0) bytes.resize(bytes.size() * (60 + random() % 40) / 100);
    const size_t page = 2 + random() % (bytes.size() / kPage - 2);
    for (size_t k = 0; k < kPage; ++k) bytes[page * kPage + k] = static_cast<char>(random());
    unlink(damaged.c_str());
    writeFileBytes(damaged, bytes);
    unlink(rescued_.c_str());
    try {
      const MapRescue saved = rescueMap(damaged, rescued_);
      if (saved.blocks_lost > 0) ++lost_some;
      EXPECT_EQ(expectGood(rescued_), saved.blocks);
      ++rescued;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("nothing can be saved"), std::string::npos) << error.what();
    }
  }
  EXPECT_GE(rescued, 12);
  EXPECT_GT(lost_some, 0);
}

TEST_F(MapCheckTest, NothingIsOverwrittenByARescue) {
  expectError([&] { rescueMap(path_, path_); }, {"holds something already"});
  writeFileBytes(folder_ / "none.map", "");
  expectError([&] { rescueMap(folder_ / "none.map", rescued_); }, {"nothing can be saved"});
}

}  // namespace
}  // namespace depth_fusion
