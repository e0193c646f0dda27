#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "common/io/text_file.h"
#include "depth_fusion/recording/recording.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "support/expect_error.h"
#include "support/real_data.h"
#include "support/temporary_folder.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

const char kIntrinsicsText[] = "10.5 0 6\n0 10.25 4\n0 0 1\n";
const char kPoseText[] = "0 -1 0 0.5\n1 0 0 -2\n0 0 1 3\n0 0 0 1\n";

std::string frameFile(const TemporaryFolder& folder, const std::string& number, const std::string& ending) {
  return folder / ("frame-" + number + ending);
}

// Frames 000002 and 000010; the second has no colour and no pose.
void makeFolder(const TemporaryFolder& folder) {
  cv::imwrite(frameFile(folder, "000010", ".depth.png"), randomDepth(10));
  cv::imwrite(frameFile(folder, "000002", ".depth.png"), randomDepth(2));
  cv::imwrite(frameFile(folder, "000002", ".color.png"), randomColor(2));
  writeText(frameFile(folder, "000002", ".pose.txt"), kPoseText);
  writeText(folder / "camera-intrinsics.txt", kIntrinsicsText);
}

TEST(SevenScenesRecording, reads_frames_in_order) {
  const TemporaryFolder folder;
  makeFolder(folder);
  const auto recording = openFolder(folder.path(), {});
  EXPECT_EQ(recording->frameCount(), 2u);
  const auto first = recording->next();
  ASSERT_TRUE(first.has_value());
  EXPECT_DOUBLE_EQ(first->stamp_s, 2.0 / 30.0);
  EXPECT_DOUBLE_EQ(first->depth_unit_m, 0.001);
  EXPECT_TRUE(sameImage(first->depth, randomDepth(2)));
  EXPECT_TRUE(sameImage(first->color, randomColor(2)));
  expectSameIntrinsics(first->intrinsics, {kTestWidth, kTestHeight, 10.5, 10.25, 6.0, 4.0});
  const auto second = recording->next();
  ASSERT_TRUE(second.has_value());
  EXPECT_DOUBLE_EQ(second->stamp_s, 10.0 / 30.0);
  EXPECT_TRUE(second->color.empty());
  EXPECT_FALSE(second->T_W_D.has_value());
  EXPECT_FALSE(recording->next().has_value());
}

TEST(SevenScenesRecording, poses_are_read_without_the_images) {
  const TemporaryFolder folder;
  makeFolder(folder);
  const Trajectory poses = readPoses(folder.path());
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_DOUBLE_EQ(poses[0].stamp_s, 2.0 / 30.0);
  EXPECT_TRUE(poses[0].T_W_D.isApprox(*openFolder(folder.path(), {})->next()->T_W_D, 1e-12));
}

TEST(SevenScenesRecording, reads_poses_as_camera_to_world) {
  const TemporaryFolder folder;
  makeFolder(folder);
  const auto T_W_D = openFolder(folder.path(), {})->next()->T_W_D;
  ASSERT_TRUE(T_W_D.has_value());
  EXPECT_TRUE((*T_W_D * Eigen::Vector3d(1.0, 0.0, 0.0)).isApprox(Eigen::Vector3d(0.5, -1.0, 3.0), 1e-12));
}

TEST(SevenScenesRecording, both_marks_of_no_depth_become_zero) {
  const TemporaryFolder folder;
  cv::Mat depth = randomDepth(0);
  depth.at<uint16_t>(1, 1) = 65535;
  depth.at<uint16_t>(1, 2) = 65534;
  cv::imwrite(frameFile(folder, "000000", ".depth.png"), depth);
  writeText(folder / "camera-intrinsics.txt", kIntrinsicsText);
  const cv::Mat read = openFolder(folder.path(), {})->next()->depth;
  EXPECT_EQ(read.at<uint16_t>(0, 0), 0);
  EXPECT_EQ(read.at<uint16_t>(1, 1), 0);
  EXPECT_EQ(read.at<uint16_t>(1, 2), 65534);
}

TEST(SevenScenesRecording, uses_the_data_sets_intrinsics_for_its_size_only) {
  const TemporaryFolder folder;
  cv::imwrite(frameFile(folder, "000000", ".depth.png"), cv::Mat(480, 640, CV_16UC1, cv::Scalar(1500)));
  expectSameIntrinsics(openFolder(folder.path(), {})->next()->intrinsics,
                       {640, 480, 585.0, 585.0, 320.0, 240.0});
  cv::imwrite(frameFile(folder, "000000", ".depth.png"), randomDepth(0));
  expectError([&] { openFolder(folder.path(), {}); }, {folder.path(), "12x8", "--intrinsics"});
  RecordingOptions options;
  options.intrinsics = CameraIntrinsics{0, 0, 11.0, 12.0, 6.0, 4.0};
  expectSameIntrinsics(openFolder(folder.path(), options)->next()->intrinsics, {12, 8, 11.0, 12.0, 6.0, 4.0});
}

TEST(SevenScenesRecording, takes_unknown_poses_as_none) {
  const TemporaryFolder folder;
  makeFolder(folder);
  for (const char* pose : {"-inf 0 0 0\n0 nan 0 0\n0 0 1 0\n0 0 0 1\n", "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0",
                           "-1.#IND 0 0 0\r\n0 1.#QNAN 0 0\r\n0 0 1.#INF 0\r\n0 0 0 1\r\n",
                           "0,0,0,0\n0,0,0,0\n0,0,0,0\n0,0,0,1\n"}) {
    writeText(frameFile(folder, "000002", ".pose.txt"), pose);
    const auto frame = openFolder(folder.path(), {})->next();
    EXPECT_FALSE(frame->T_W_D.has_value()) << pose;
    EXPECT_FALSE(frame->depth.empty()) << pose;
    expectError([&] { readPoses(folder.path()); }, {folder.path(), "no poses"});
  }
}

TEST(SevenScenesRecording, poses_that_cannot_be_read_cost_no_depth_and_are_named_where_they_are_asked_for) {
  const TemporaryFolder folder;
  makeFolder(folder);
  const std::string pose = frameFile(folder, "000002", ".pose.txt");
  const auto expectBadPose = [&](const std::string& text, const std::string& word) {
    writeText(pose, text);
    const auto frame = openFolder(folder.path(), {})->next();
    EXPECT_DOUBLE_EQ(frame->stamp_s, 2.0 / 30.0);
    EXPECT_FALSE(frame->T_W_D.has_value());
    expectError([&] { readPoses(folder.path()); }, {pose, word});
  };
  expectBadPose("1 0 0 0\n0 1 0 0\n", "4x4");
  expectBadPose("2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "no rotation");
  expectBadPose("-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "no rotation");
}

TEST(SevenScenesRecording, one_bad_pose_file_costs_itself_and_is_said_where_somebody_listens) {
  const TemporaryFolder folder;
  makeFolder(folder);
  writeText(frameFile(folder, "000002", ".pose.txt"), "1 0 0 0.5\n0 1 0 0\n0 0 1 0\n");
  writeText(frameFile(folder, "000010", ".pose.txt"), "");
  std::string remark;
  const Trajectory poses = readPoses(folder.path(), &remark);
  ASSERT_EQ(poses.size(), 1u) << "a matrix without its last row is a pose";
  EXPECT_EQ(poses[0].T_W_D.translation().x(), 0.5);
  EXPECT_EQ(remark.find("1 pose file left out: " + frameFile(folder, "000010", ".pose.txt")), 0u) << remark;
}

TEST(SevenScenesRecording, takes_intrinsics_as_other_tools_write_them) {
  const TemporaryFolder folder;
  makeFolder(folder);
  for (const char* text : {"11 0 6 0\r\n0 12 4 0\r\n0 0 1 0\r\n0 0 0 1\r\n", "11 0 6 0\n0 12 4 0\n0 0 1 0\n",
                           "11,0 0 6,0\n0 12,0 4,0\n0 0 1\n", "11;0;6\n0;12;4\n0;0;1\n"}) {
    writeText(folder / "camera-intrinsics.txt", text);
    expectSameIntrinsics(openFolder(folder.path(), {})->next()->intrinsics, {12, 8, 11.0, 12.0, 6.0, 4.0});
  }
}

TEST(SevenScenesRecording, names_bad_files_and_goes_on) {
  const TemporaryFolder folder;
  makeFolder(folder);
  const auto expectBadFirst = [&](const std::vector<std::string>& words) {
    const auto recording = openFolder(folder.path(), {});
    expectError([&] { recording->next(); }, words);
    EXPECT_DOUBLE_EQ(recording->next()->stamp_s, 10.0 / 30.0);
  };
  const std::string depth = frameFile(folder, "000002", ".depth.png");
  fs::resize_file(depth, fs::file_size(depth) / 2);
  expectBadFirst({depth, "truncated"});
}

TEST(SevenScenesRecording, truncated_colour_costs_no_depth) {
  const TemporaryFolder folder;
  makeFolder(folder);
  const std::string color = frameFile(folder, "000002", ".color.png");
  fs::resize_file(color, fs::file_size(color) - 5);
  const auto frame = openFolder(folder.path(), {})->next();
  EXPECT_FALSE(frame->depth.empty());
  EXPECT_TRUE(frame->color.empty());
  EXPECT_NE(frame->color_problem.find(color), std::string::npos) << frame->color_problem;
}

TEST(SevenScenesRecording, names_bad_intrinsics_and_folders_without_depth) {
  const TemporaryFolder folder;
  makeFolder(folder);
  writeText(folder / "camera-intrinsics.txt", "585 0 320\n");
  expectError([&] { openFolder(folder.path(), {}); }, {folder / "camera-intrinsics.txt", "3x3"});
  const std::string first = frameFile(folder, "000002", ".depth.png");
  writeText(first, "no image");
  writeText(frameFile(folder, "000010", ".depth.png"), "no image");
  expectError([&] { openFolder(folder.path(), {}); }, {folder.path(), "none of its 2 files", first});
  fs::remove(first);
  fs::remove(frameFile(folder, "000010", ".depth.png"));
  expectError([&] { openFolder(folder.path(), {}); }, {folder.path(), "no recording"});
}

TEST(SevenScenesRecording, knows_the_data_sets_colour_camera_and_no_other) {
  const TemporaryFolder folder;
  cv::imwrite(frameFile(folder, "000000", ".depth.png"), cv::Mat(480, 640, CV_16UC1, cv::Scalar(1500)));
  cv::imwrite(frameFile(folder, "000000", ".color.png"), cv::Mat(480, 640, CV_8UC3, cv::Scalar(1, 2, 3)));
  const auto frame = openFolder(folder.path(), {})->next();
  ASSERT_TRUE(frame->color_intrinsics && frame->T_C_D);
  EXPECT_EQ(frame->color_intrinsics->fx, 525.0);
  EXPECT_NEAR(frame->T_C_D->translation().norm(), 0.025, 0.003);
  writeText(folder / "camera-intrinsics.txt", "525 0 320\n0 525 240\n0 0 1\n");
  const auto registered = openFolder(folder.path(), {})->next();
  EXPECT_FALSE(registered->color_intrinsics || registered->T_C_D);
}

TEST(SevenScenesRecording, reads_the_real_redkitchen) {
  const std::string path = realDataFolder("redkitchen");
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
  const auto recording = openFolder(path, {});
  EXPECT_EQ(recording->frameCount(), 300u);
  int count = 0;
  while (const auto frame = recording->next()) {
    EXPECT_NEAR(frame->stamp_s, count / 30.0, 1e-9);
    ++count;
    EXPECT_EQ(frame->color.size(), cv::Size(640, 480));
    ASSERT_TRUE(frame->T_W_D.has_value());
    EXPECT_TRUE((frame->T_W_D->linear() * frame->T_W_D->linear().transpose()).isIdentity(1e-12));
    expectSameIntrinsics(frame->intrinsics, {640, 480, 585.0, 585.0, 320.0, 240.0});
    EXPECT_EQ(cv::countNonZero(frame->depth == 65535), 0);
    const double mean_m = cv::mean(frame->depth, frame->depth > 0)[0] * frame->depth_unit_m;
    EXPECT_GT(mean_m, 0.5);
    EXPECT_LT(mean_m, 4.0);
  }
  EXPECT_EQ(count, 300);
}

}  // namespace
}  // namespace depth_fusion
