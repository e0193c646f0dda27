#include <gtest/gtest.h>

#include "common/io/text_file.h"
#include "depth_fusion/recording/recording.h"
#include "depth_fusion/recording/recording_writer.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

TEST(TumWriter, writes_poses_as_groundtruth_and_never_reads_them_into_frames) {
  const TemporaryFolder folder;
  const auto writer = createTumFolder(folder / "room");
  for (int i = 0; i < 2; ++i) {
    RgbdFrame frame = testFrame(i);
    if (i == 1) frame.T_W_D = Pose(Eigen::Translation3d(1.0, 2.0, 3.0));
    writer->write(frame);
  }
  writer->finish();
  const Trajectory groundtruth = readTrajectory(folder / "room/groundtruth.txt");
  ASSERT_EQ(groundtruth.size(), 1u);
  EXPECT_EQ(groundtruth[0].stamp_s, testFrame(1).stamp_s);
  EXPECT_EQ(groundtruth[0].T_W_D.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  const auto recording = openFolder(folder / "room", {});
  while (const auto frame = recording->next()) EXPECT_FALSE(frame->T_W_D.has_value());
}

TEST(TumWriter, converts_other_units_rounding_to_nearest) {
  const TemporaryFolder folder;
  RgbdFrame frame = testFrame(0);
  frame.depth.setTo(0);
  frame.depth_unit_m = 0.0005;  // 2.5 values of the layout
  frame.depth.at<uint16_t>(1, 1) = 1001;
  frame.depth.at<uint16_t>(1, 2) = 2;
  frame.depth.at<uint16_t>(1, 3) = 26214;
  frame.depth.at<uint16_t>(1, 4) = 26215;
  const auto writer = createTumFolder(folder / "room");
  writer->write(frame);
  writer->finish();
  const cv::Mat depth = openFolder(folder / "room", {})->next()->depth;
  EXPECT_NEAR(depth.at<uint16_t>(1, 1), 2502.5, 0.5);
  EXPECT_EQ(depth.at<uint16_t>(1, 2), 5);
  EXPECT_EQ(depth.at<uint16_t>(1, 3), 65535);
  EXPECT_EQ(depth.at<uint16_t>(1, 4), 0) << "13.1075 m do not fit";
  EXPECT_EQ(depth.at<uint16_t>(0, 0), 0);
}

TEST(TumWriter, keeps_units_that_are_finer_than_the_layouts) {
  const TemporaryFolder folder;
  RgbdFrame frame = testFrame(0);
  frame.depth_unit_m = 0.00001;
  frame.depth.at<uint16_t>(1, 1) = 25001;
  const auto writer = createTumFolder(folder / "seal");
  writer->write(frame);
  writer->finish();
  const RgbdFrame read = *openFolder(folder / "seal", {})->next();
  EXPECT_NEAR(read.depth_unit_m, 0.00001, 1e-15);
  EXPECT_EQ(read.depth.at<uint16_t>(1, 1), 25001);
}

TEST(TumWriter, takes_frames_without_colour_and_with_gray) {
  const TemporaryFolder folder;
  const auto writer = createTumFolder(folder / "room");
  RgbdFrame frame = testFrame(0);
  frame.color.release();
  writer->write(frame);
  frame = testFrame(1);
  frame.color = randomColor(1, CV_8UC1);
  writer->write(frame);
  writer->finish();
  const auto recording = openFolder(folder / "room", {});
  EXPECT_TRUE(recording->next()->color.empty());
  EXPECT_TRUE(sameImage(recording->next()->color, frame.color));
}

TEST(TumWriter, says_when_it_cannot_write) {
  const TemporaryFolder folder;
  writeText(folder / "file", "x");
  expectError([&] { createTumFolder(folder / "file/room"); }, {folder / "file/room", "cannot be made"});
  const auto writer = createTumFolder(folder / "room");
  expectError([&] { writer->finish(); }, {folder / "room", "no frame"});
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const std::string image = folder / ("room/depth/" + stampText(testFrame(0).stamp_s) + ".png");
  fs::create_symlink("/dev/full", image);
  expectError([&] { writer->write(testFrame(0)); }, {image, "No space left"});
  writer->write(testFrame(1));
  fs::create_symlink("/dev/full", folder / "room/depth.txt");
  expectError([&] { writer->finish(); }, {folder / "room/depth.txt", "No space left"});
}

TEST(TumWriter, refuses_what_would_spoil_a_recording) {
  const TemporaryFolder folder;
  const auto first = createTumFolder(folder / "room");
  first->write(testFrame(0));
  first->finish();
  expectError([&] { createTumFolder(folder / "room"); }, {folder / "room", "already holds a recording"});
  const auto writer = createTumFolder(folder / "other");
  writer->write(testFrame(1));
  expectError([&] { writer->write(testFrame(1)); }, {folder / "other", "not later"});
  RgbdFrame frame = testFrame(2);
  frame.intrinsics.fx = 11.0;
  expectError([&] { writer->write(frame); }, {folder / "other", "intrinsics change"});
  frame = testFrame(2);
  frame.depth.convertTo(frame.depth, CV_32F);
  expectError([&] { writer->write(frame); }, {"CV_16UC1", "CV_32FC1"});
}

}  // namespace
}  // namespace depth_fusion
