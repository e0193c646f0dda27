// What is refused, what fails, and that nothing is lost by it.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "submaps/row_keys.h"
#include "support/expect_error.h"
#include "support/full_disk.h"
#include "support/map_file_fixture.h"
#include "support/postgres_server.h"

namespace depth_fusion {
namespace {

class MapRefusals : public MapFile {};

TEST_F(MapRefusals, MapsThatDoNotFitAreRefusedAndNothingIsLost) {
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  MapSaver saver(path_);
  save(saver, map_);
  const auto refuses = [&](MapParameters parameters, const std::vector<std::string>& words) {
    BlockMap other(compute(), parameters);
    ChangingMap(compute(), other).show(sphere({0.0, 0.0, 0.0}, 0.05));
    const MapContent before = readMap(other);
    expectError([&] { load(path_, other); }, words);
    EXPECT_TRUE(readMap(other) == before);
  };
  MapParameters parameters = smallMap();
  parameters.voxel_size_m = 0.02f;
  refuses(parameters, {"ball.map", "map/voxel_size_m", "0.01", "0.02"});
  parameters = smallMap();
  parameters.block_size = 4;
  refuses(parameters, {"map/block_size", "set it to 8"});
}

TEST_F(MapRefusals, WhatIsDamagedIsNamedAndNothingIsLost) {
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  MapSaver saver(path_);
  save(saver, map_, {someKeyframe(0.0)});
  const auto database = openDatabase(path_, DatabaseAccess::kWrite);
  std::map<std::string, std::string> rows;
  database->read()->forEach("", [&](const auto& key, const auto& value) { rows[key] = value; });
  const MapContent before = readMap(map_);
  const auto put = [&](const std::string& key, const std::string& value) {
    const auto writer = database->write();
    writer->put(key, value);
    writer->commit();
  };
  std::mt19937 random(1);
  for (const auto& [key, value] : rows) {
    std::string damaged = value;
    damaged[random() % damaged.size()] ^= 4;
    put(key, damaged);
    expectError([&] { loadMap(*database, map_); }, {"ball.map", "row " + readable(key)});
    put(key, value);
  }
  for (const auto& [key, value] : rows) {
    if (key.rfind("keyframe", 0) == 0) continue;  // one less is no damage
    const auto writer = database->write();
    writer->erase(key);
    writer->commit();
    EXPECT_THROW(loadMap(*database, map_), Error) << readable(key);
    put(key, value);
  }
  EXPECT_TRUE(readMap(map_) == before);
}

TEST_F(MapRefusals, WhatIsNoMapIsNotOverwritten) {
  {
    const auto writer = openDatabase(path_, DatabaseAccess::kWrite)->write();
    writer->put("accounts", "1000");
    writer->commit();
  }
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  MapSaver saver(path_);
  expectError([&] { save(saver, map_); }, {path_, "something else than a map"});
  EXPECT_EQ(openDatabase(path_, DatabaseAccess::kRead)->read()->get("accounts"), "1000");
}

TEST_F(MapRefusals, WhatAnotherSaverWroteIsNotMixed) {
  MapSaver mine(path_), theirs(path_);
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  save(mine, map_);
  BlockMap other(compute(), smallMap());
  ChangingMap(compute(), other).show(sphere({0.1, 0.1, 0.1}, 0.05));
  save(theirs, other);
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.14));
  EXPECT_EQ(save(mine, map_).blocks_written, map_.slots().used())
      << "all of it, for the place has another map";
  // It comes between the copy and the writing.
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.13));
  capture(mine, map_);
  save(theirs, other);
  expectError([&] { mine.write(); }, {path_, "holds another map by now"});
  save(mine, map_);
  BlockMap third(compute(), smallMap());
  load(path_, third);
  expectSame(map_, third);
}

TEST_F(MapRefusals, AFailedSaveIsMadeUpFor) {
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  MapSaver saver(folder_ / "later/ball.map");
  EXPECT_THROW(save(saver, map_), Error);
  std::filesystem::create_directory(folder_ / "later");
  save(saver, map_);
  BlockMap other(compute(), smallMap());
  load(folder_ / "later/ball.map", other);
  expectSame(map_, other);
}

TEST_F(MapRefusals, AFullDiskLosesNothing) {
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  MapSaver saver(path_);
  save(saver, map_);
  const MapContent stored = readMap(map_);
  BlockMap other(compute(), smallMap());
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.14));
  {
    const FullDisk full;
    expectError([&] { save(saver, map_); }, {path_, "cannot be written"});
    load(path_, other);
    EXPECT_TRUE(readMap(other) == stored);
  }
  changing_.show(sphere({0.0, 0.02, 0.0}, 0.13));
  save(saver, map_);
  load(path_, other);
  expectSame(map_, other);
}

TEST(MapOnAServer, ItIsSavedAndLoadedThroughRestarts) {
  if (PostgresServer::programs().empty()) GTEST_SKIP() << "no PostgreSQL server here";
  PostgresServer server;
  BlockMap map(compute(), smallMap());
  ChangingMap changing(compute(), map);
  changing.show(sphere({0.0, 0.0, 0.0}, 0.15));
  MapSaver saver(server.uri("ball"));
  save(saver, map, {someKeyframe(1.0)});
  server.stop();
  changing.show(sphere({0.02, 0.0, 0.0}, 0.13));
  expectError([&] { save(saver, map); }, {"#ball", "cannot be reached"});
  server.start();
  const SaveReport report = save(saver, map, {someKeyframe(1.0)});
  EXPECT_LT(report.blocks_written, 2 * report.blocks);
  BlockMap other(compute(), smallMap());
  EXPECT_EQ(load(server.uri("ball"), other).keyframes.size(), 1u);
  expectSame(map, other);
}

}  // namespace
}  // namespace depth_fusion
