// A sensor's way through a map that is larger than its memory.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>

#include "depth_fusion/submaps/map_file.h"
#include "depth_fusion/submaps/submap_collection.h"
#include "shared/types.h"
#include "submaps/whole_map.h"
#include "support/stored_maps.h"
#include "support/temporary_folder.h"
#include "support/test_compute.h"

namespace depth_fusion {

const CameraIntrinsics kWalkCamera{64, 48, 50.0, 50.0, 31.5, 23.5};
constexpr double kWalkRange_m = 1.0;

using Contents = std::map<BlockIndex, std::string, BlockOrder>;

// A sensor that goes through a map and writes into what it sees, and what should be in the map.
class Walk {
 public:
  Walk(const MapParameters& map, const SubmapParameters& parameters)
      : map_(compute(), map), submaps_(map_, parameters), random_(3) {}

  // The sensor looks along x, or back, from there.
  void goTo(double x_m, double y_m = 0.0, bool back = false, bool is_given = true) {
    const Pose T_W_D = poseAt(x_m, y_m, back);
    submaps_.enter(T_W_D, is_given);
    submaps_.show(kWalkCamera, T_W_D, kWalkRange_m);
    write(T_W_D);
  }

  // The same without writing.
  void look(double x_m, bool back = false) {
    const Pose T_W_D = poseAt(x_m, 0.0, back);
    submaps_.enter(T_W_D, true);
    submaps_.show(kWalkCamera, T_W_D, kWalkRange_m);
  }

  SaveReport save(MapSaver& saver) {
    saver.prepare();
    saver.capture(submaps_, describing(map_), {});
    return saver.write();
  }

  // All the blocks of the map, wherever they are; of the pool only those in view must be there.
  void expectAll() {
    TemporaryFolder folder;
    MapSaver saver(folder / "whole.map");
    const SaveReport report = save(saver);
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
    const std::vector<SlotTable::Block> blocks = map.slots().blocks();
    std::vector<int> slots;
    for (const SlotTable::Block& block : blocks) slots.push_back(block.slot);
    const std::string voxels = map.voxels(kTsdfLayer, slots);
    Contents contents;
    for (size_t i = 0; i < blocks.size(); ++i) contents[blocks[i].index] = voxels.substr(1024 * i, 1024);
    return contents;
  }

 private:
  static Pose poseAt(double x_m, double y_m, bool back) {
    Pose T_W_D = Pose::Identity();
    T_W_D.linear() << 0, 0, back ? -1 : 1, -1, 0, 0, 0, back ? 1 : -1, 0;
    T_W_D.translation() << x_m, y_m, 0.0;
    return T_W_D;
  }

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
      // Compression does not make it smaller.
      std::string content(1024, 'x');
      for (char& byte : content) byte = static_cast<char>(random_());
      expected_[block.index] = content;
      changed.push_back(block.slot);
      voxels += content;
    }
    map_.setVoxels(kTsdfLayer, changed, voxels);
    map_.setStates(changed, std::vector<int>(changed.size(), BLOCK_HAS_DATA | BLOCK_SURE));
    map_.noteUpdated(changed);
    map_.remove(gone);
  }

  BlockMap map_;
  SubmapCollection submaps_;
  Contents expected_;
  std::mt19937 random_;
};

}  // namespace depth_fusion
