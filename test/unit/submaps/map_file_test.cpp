#include "depth_fusion/submaps/map_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "submaps/row_keys.h"
#include "support/map_file_fixture.h"

namespace depth_fusion {
namespace {

TEST_F(MapFile, AMapComesBackBitForBit) {
  changing_.show(sphere({0.01, -0.02, 0.03}, 0.15));
  std::vector<int> states(map_.slots().bound());
  for (size_t i = 0; i < states.size(); ++i) states[i] = static_cast<int>(i % 512);
  map_.blockStates().write(states);
  MapSaver saver(path_);
  const SaveReport report = save(saver, map_, {someKeyframe(1.0), someKeyframe(2.0)});
  EXPECT_EQ(report.blocks, map_.slots().used());
  EXPECT_EQ(report.blocks_written, report.blocks);
  EXPECT_EQ(report.bytes, std::filesystem::file_size(path_));

  BlockMap other(compute(), smallMap());
  ChangingMap(compute(), other).show(sphere({0.0, 0.0, 0.0}, 0.05));  // is gone afterwards
  const uint32_t generation = other.generation();
  const LoadedMap loaded = load(path_, other);
  expectSame(map_, other);
  EXPECT_NE(other.generation(), generation);
  EXPECT_EQ(other.window().origin, map_.window().origin);
  ASSERT_EQ(loaded.keyframes.size(), 2u);
  EXPECT_EQ(loaded.keyframes[1]->T_W_D.translation().x(), 2.0);
  EXPECT_EQ(loaded.description.last_pose.T_W_D.translation().z(), 3.0);
  ASSERT_EQ(loaded.description.submaps.size(), 1u);
  EXPECT_EQ(loaded.description.submaps[0].blocks, map_.slots().used());
}

TEST_F(MapFile, LaterSavesWriteWhatHasChanged) {
  MapSaver saver(path_);
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  const KeyframePtr kept = someKeyframe(1.0);
  save(saver, map_, {kept, someKeyframe(2.0)});
  EXPECT_EQ(save(saver, map_).blocks_written, 0u);
  // A part of it moves away, another one comes.
  changing_.show(sphere({0.02, 0.0, 0.0}, 0.13));
  const SaveReport report = save(saver, map_, {kept, someKeyframe(3.0)});
  EXPECT_GT(report.blocks_written, 0u);
  BlockMap other(compute(), smallMap());
  const LoadedMap loaded = load(path_, other);
  expectSame(map_, other);
  EXPECT_EQ(loaded.description.revision, 3u);
  ASSERT_EQ(loaded.keyframes.size(), 2u);
  EXPECT_EQ(loaded.keyframes[0]->T_W_D.translation().x(), 1.0);
  EXPECT_EQ(loaded.keyframes[1]->T_W_D.translation().x(), 3.0);
}

TEST_F(MapFile, AMapThatWasEmptiedIsWrittenAnew) {
  MapSaver saver(path_);
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  save(saver, map_, {someKeyframe(1.0)});
  map_.reset(Eigen::Vector3d::Zero());
  changing_.show(sphere({0.1, 0.0, 0.0}, 0.05));
  save(saver, map_);
  BlockMap other(compute(), smallMap());
  EXPECT_TRUE(load(path_, other).keyframes.empty());
  expectSame(map_, other);
}

TEST_F(MapFile, ALoadedMapGoesOn) {
  {
    MapSaver saver(path_);
    changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
    save(saver, map_, {someKeyframe(1.0)});
  }
  BlockMap other(compute(), smallMap());
  const LoadedMap loaded = load(path_, other);
  MapSaver saver(path_);
  adopt(saver, other, loaded);
  EXPECT_EQ(save(saver, other, loaded.keyframes).blocks_written, 0u);
  ChangingMap(compute(), other).show(sphere({0.0, 0.0, 0.0}, 0.14));
  save(saver, other, loaded.keyframes);
  BlockMap third(compute(), smallMap());
  EXPECT_EQ(load(path_, third).keyframes.size(), 1u);
  expectSame(other, third);
}

TEST_F(MapFile, AMapComesBackIntoAWindowOfAnotherSize) {
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  MapSaver saver(path_);
  save(saver, map_);
  MapParameters parameters = smallMap();
  parameters.blocks_per_axis = 40;
  BlockMap larger(compute(), parameters);
  load(path_, larger);
  expectSame(map_, larger);
}

TEST_F(MapFile, ColourComesBackAndMayBeLeftOut) {
  MapParameters with_color = smallMap();
  with_color.color = true;
  BlockMap colored(compute(), with_color);
  ChangingMap(compute(), colored).show(sphere({0.0, 0.0, 0.0}, 0.15));
  std::vector<uint32_t> colors(512 * colored.slots().bound());
  for (uint32_t i = 0; i < colors.size(); ++i) colors[i] = 2654435761u * i;
  colored.layer(kColorLayer).write(colors);
  MapSaver saver(path_);
  save(saver, colored);
  BlockMap same(compute(), with_color);
  load(path_, same);
  expectSame(colored, same);
  std::map<BlockKey, std::vector<uint32_t>> contents[2];
  for (BlockMap* map : {&colored, &same}) {
    const auto all = map->layer(kColorLayer).read<uint32_t>(512 * map->slots().bound());
    for (const SlotTable::Block& block : map->slots().blocks())
      contents[map == &same][keyOf(block.index)] = {all.begin() + 512 * block.slot,
                                                    all.begin() + 512 * (block.slot + 1)};
  }
  EXPECT_EQ(contents[0], contents[1]);
  load(path_, map_);
  expectSame(colored, map_);
}

// A map goes on in one with another choice of layers: what is stored is one map all the same.
TEST_F(MapFile, AMapGoesOnWithAnotherChoiceOfLayers) {
  MapParameters with_color = smallMap();
  with_color.color = true;
  for (const bool color_first : {false, true}) {
    const std::string path = folder_ / (color_first ? "colored.map" : "grey.map");
    BlockMap first(compute(), color_first ? with_color : smallMap());
    ChangingMap(compute(), first).show(sphere({0.0, 0.0, 0.0}, 0.15));
    MapSaver first_saver(path);
    save(first_saver, first);
    BlockMap second(compute(), color_first ? smallMap() : with_color);
    const LoadedMap loaded = load(path, second);
    MapSaver saver(path);
    adopt(saver, second, loaded);
    ChangingMap(compute(), second).show(sphere({0.02, 0.0, 0.0}, 0.14));
    save(saver, second, loaded.keyframes);
    BlockMap third(compute(), with_color);
    EXPECT_EQ(load(path, third).description.layers.size(), color_first ? 1u : 2u);
    expectSame(second, third);
  }
}

TEST_F(MapFile, WhatHasNotChangedNeedNoSave) {
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  const Keyframes keyframes = {someKeyframe(1.0)};
  MapSaver saver(path_);
  save(saver, map_, keyframes);
  const auto changesWith = [&](const Keyframes& now) {
    capture(saver, map_, now);
    return saver.hasChanges();
  };
  EXPECT_FALSE(changesWith(keyframes));
  EXPECT_TRUE(changesWith({someKeyframe(1.0)}));
  EXPECT_TRUE(changesWith({}));
  changing_.show(sphere({0.01, 0.0, 0.0}, 0.15));
  EXPECT_TRUE(changesWith(keyframes));
}

TEST_F(MapFile, AFileThatWasMovedAwayIsMadeAnew) {
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.15));
  MapSaver saver(path_);
  save(saver, map_);
  std::filesystem::rename(path_, folder_ / "old.map");
  changing_.show(sphere({0.0, 0.0, 0.0}, 0.14));
  save(saver, map_);
  BlockMap other(compute(), smallMap());
  load(path_, other);
  expectSame(map_, other);
}

}  // namespace
}  // namespace depth_fusion
