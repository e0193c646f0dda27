// What is written into rows comes back out of them, and what is damaged is found.
#include <gtest/gtest.h>

#include <random>

#include "common/io/bytes.h"
#include "store/packed_row.h"
#include "submaps/block_rows.h"
#include "submaps/description_rows.h"
#include "submaps/keyframe_rows.h"
#include "submaps/row_keys.h"
#include "support/expect_error.h"

namespace depth_fusion {
namespace {

MapDescription someDescription() {
  MapDescription description;
  description.id = 0x123456789abcdef0;
  description.revision = 42;
  description.saved_at_s = 1.5e9;
  description.software = "depth_fusion of a test";
  description.parameters = {{"map/voxel_size_m", "0.005"}, {"icp_tracking/x", ""}};
  description.camera = {640, 480, 525.0, 526.0, 319.5, 239.5};
  description.last_pose.stamp_s = 17.25;
  description.last_pose.T_W_D = poseFromTwist((Vector6d() << 0.1, -0.2, 0.3, 1.0, 2.0, 3.0).finished());
  description.way_m = 123.5;
  description.active_submap = 3;
  description.layers = {"tsdf", "color"};
  return description;
}

TEST(Rows, ADescriptionComesBack) {
  const MapDescription before = someDescription();
  const MapDescription after = parseDescription(descriptionRow(before), "row");
  EXPECT_EQ(after.id, before.id);
  EXPECT_EQ(after.revision, before.revision);
  EXPECT_EQ(after.saved_at_s, before.saved_at_s);
  EXPECT_EQ(after.software, before.software);
  EXPECT_EQ(after.parameters, before.parameters);
  EXPECT_TRUE(sameCamera(after.camera, before.camera));
  EXPECT_EQ(after.last_pose.stamp_s, before.last_pose.stamp_s);
  EXPECT_EQ(after.last_pose.T_W_D.matrix(), before.last_pose.T_W_D.matrix());
  EXPECT_EQ(after.way_m, before.way_m);
  EXPECT_EQ(after.active_submap, before.active_submap);
  EXPECT_EQ(after.layers, before.layers);
  EXPECT_EQ(after.parameter("map/voxel_size_m"), "0.005");
  expectError([&] { after.parameter("map/none"); }, {"map/none"});
}

TEST(Rows, ASubmapComesBack) {
  SubmapDescription before{7, someDescription().last_pose.T_W_D, {{-5, 6, -7}, 256}, 1234567890123, 12.5};
  const SubmapDescription after = parseSubmap(submapRow(before), "row");
  EXPECT_EQ(after.id, 7u);
  EXPECT_EQ(after.T_W_S.matrix(), before.T_W_S.matrix());
  EXPECT_EQ(after.window.origin, before.window.origin);
  EXPECT_EQ(after.window.blocks_per_axis, 256);
  EXPECT_EQ(after.blocks, before.blocks);
  EXPECT_EQ(after.left_at_m, 12.5);
}

TEST(Rows, AnotherVersionIsRefusedByName) {
  std::string contents = unpacked(descriptionRow(someDescription()), "row");
  const size_t version_at = sizeof(uint32_t) + std::string("depth_fusion map").size();
  ++contents[version_at];
  expectError([&] { parseDescription(packed(contents), "kitchen.map"); },
              {"kitchen.map", "format 4", "depth_fusion of a test", "take a newer one"});
  contents[version_at] = 1;
  expectError([&] { parseDescription(packed(contents), "kitchen.map"); }, {"kitchen.map", "format 1"});
  contents[version_at] = 2;
  EXPECT_NO_THROW(parseDescription(packed(contents), "kitchen.map")) << "the format of before is read";
  expectError([&] { parseDescription(packed("something else"), "kitchen.map"); }, {"kitchen.map"});
}

TEST(Rows, APoseThatIsNoneIsRefused) {
  MapDescription description = someDescription();
  description.last_pose.T_W_D.linear() *= 2.0;
  expectError([&] { parseDescription(descriptionRow(description), "row"); }, {"row", "pose"});
}

class BlockRows : public testing::TestWithParam<int> {};

TEST_P(BlockRows, BlocksComeBack) {
  const int block_size = GetParam(), edge = groupEdge(block_size);
  const BlockIndex index(-3, 4, -1);
  MapParameters parameters;
  parameters.color = true;
  std::mt19937 random(3);
  for (const LayerRow& layer : layersOf(parameters)) {
    BlockGroup group;
    for (int i = 0; i < edge * edge * edge; i += 1 + static_cast<int>(random() % 5)) {
      group.blocks.emplace_back(edge * index + BlockIndex(i % edge, i / edge % edge, i / edge / edge));
      group.states.push_back(static_cast<int>(random() % 512));
    }
    group.voxels.resize(group.blocks.size() * layer.bytesPerBlock(block_size));
    for (char& byte : group.voxels) byte = static_cast<char>(random());
    const std::string row = blocksRow(group, index, layer, block_size);
    const BlockGroup after = parseBlocks(row, index, layer, block_size, "row");
    EXPECT_EQ(after.blocks, group.blocks);
    EXPECT_EQ(after.states, group.states);
    EXPECT_EQ(after.voxels, group.voxels);
    for (const BlockIndex& block : group.blocks) EXPECT_EQ(groupOf(block, edge), index);
    EXPECT_THROW(parseBlocks(row, index, layer, block_size / 2, "row"), Error);
  }
}

INSTANTIATE_TEST_SUITE_P(BlockSizes, BlockRows, testing::Values(4, 8, 16, 32));

TEST(Rows, GroupsAreFoundFromTheirKeysAndFollowEachOther) {
  const std::string prefix = blocksPrefix(1, "tsdf");
  std::string last;
  for (const int z : {-2000000, -1, 0, 1, 300}) {
    for (const int x : {-70000, -1, 0, 5}) {
      const std::string key = blocksKey(1, "tsdf", {x, 9, z});
      EXPECT_EQ(groupOfKey(key, prefix), BlockIndex(x, 9, z));
      EXPECT_LT(last, key);
      last = key;
    }
  }
  EXPECT_EQ(groupOf({-1, 0, -4}, 4), BlockIndex(-1, 0, -1));
  EXPECT_EQ(groupOf({-5, 3, 4}, 4), BlockIndex(-2, 0, 1));
  EXPECT_THROW(groupOfKey(prefix + "short", prefix), Error);
}

Keyframe someKeyframe() {
  Keyframe keyframe;
  keyframe.T_W_D = someDescription().last_pose.T_W_D;
  keyframe.thumbnail = cv::Mat(kThumbnailHeight_px, kThumbnailWidth_px, CV_32FC1);
  cv::randu(keyframe.thumbnail, -1.0, 1.0);
  keyframe.features.camera = someDescription().camera;
  keyframe.features.T_C_D.translation().x() = 0.025;
  keyframe.features.depth_sensor.sigma_base_m = 0.003f;
  for (int i = 0; i < 10; ++i) {
    Feature feature;
    feature.level = i % 3;
    feature.pixel = {10 * i, 7 * i};
    feature.descriptor.fill(0x0123456789abcdef * i);
    feature.patch.fill(static_cast<uint8_t>(i));
    if (i % 2 == 0) feature.surface_C = Eigen::Vector3d(0.1, 0.2, 0.3 * i);
    keyframe.features.features.push_back(feature);
  }
  return keyframe;
}

TEST(Rows, AKeyframeComesBack) {
  const Keyframe before = someKeyframe();
  const Keyframe after = parseKeyframe(keyframeRow(before), "row");
  EXPECT_EQ(after.T_W_D.matrix(), before.T_W_D.matrix());
  EXPECT_EQ(cv::norm(after.thumbnail, before.thumbnail), 0.0);
  EXPECT_TRUE(sameCamera(after.features.camera, before.features.camera));
  EXPECT_EQ(after.features.T_C_D.matrix(), before.features.T_C_D.matrix());
  EXPECT_EQ(after.features.depth_sensor.sigma_base_m, 0.003f);
  ASSERT_EQ(after.features.features.size(), 10u);
  for (size_t i = 0; i < 10; ++i) {
    const Feature &a = after.features.features[i], &b = before.features.features[i];
    EXPECT_EQ(a.level, b.level);
    EXPECT_EQ(a.pixel, b.pixel);
    EXPECT_EQ(a.descriptor, b.descriptor);
    EXPECT_EQ(a.patch, b.patch);
    EXPECT_EQ(a.surface_C, b.surface_C);
  }
}

TEST(Rows, WhatLoopsAreClosedByComesBack) {
  Keyframe before = someKeyframe();
  before.view =
      KeyframeView(cv::Mat(24, 32, CV_32FC1, cv::Scalar(1.5)), {32, 24, 26.0, 26.0, 15.5, 11.5}, 32);
  before.color = {"a picture", {64, 48, 52.0, 52.0, 31.5, 23.5}, Pose(Eigen::Translation3d(0.0, 0.025, 0.0))};
  before.stamp_s = 12.5;
  before.way_m = 77.25;
  const Keyframe after = parseKeyframe(keyframeRow(before), "row");
  EXPECT_EQ(after.view.packed(), before.view.packed());
  EXPECT_TRUE(sameCamera(after.view.camera(), before.view.camera()));
  EXPECT_EQ(after.color.jpeg, "a picture");
  EXPECT_TRUE(sameCamera(after.color.camera, before.color.camera));
  EXPECT_TRUE(after.color.T_C_D.isApprox(before.color.T_C_D));
  EXPECT_EQ(after.stamp_s, 12.5);
  EXPECT_EQ(after.way_m, 77.25);
}

TEST(Rows, AKeyframeOfTheFormatBeforeIsRead) {
  const std::string contents = unpacked(keyframeRow(someKeyframe()), "row");
  constexpr size_t kLoopPartBytes = 8 + 8 + 4 + 4;  // stamp, way, an empty view, no colour
  const Keyframe after = parseKeyframe(packed(contents.substr(0, contents.size() - kLoopPartBytes)), "row");
  EXPECT_EQ(after.features.features.size(), 10u);
  EXPECT_TRUE(after.view.isEmpty());
  expectError([&] { parseKeyframe(packed(contents.substr(0, contents.size() - 3)), "row 5"); }, {"row 5"});
}

TEST(Rows, AKeyframeThatCannotBeIsRefused) {
  Keyframe keyframe = someKeyframe();
  keyframe.features.features[3].level = 200;
  EXPECT_THROW(parseKeyframe(keyframeRow(keyframe), "row"), Error);
  keyframe = someKeyframe();
  keyframe.thumbnail = keyframe.thumbnail.rowRange(0, 4).clone();
  EXPECT_THROW(parseKeyframe(keyframeRow(keyframe), "row"), Error);
  keyframe = someKeyframe();
  keyframe.features.depth_sensor.sigma_base_m = -1.0f;
  EXPECT_THROW(parseKeyframe(keyframeRow(keyframe), "row"), Error);
}

}  // namespace
}  // namespace depth_fusion
