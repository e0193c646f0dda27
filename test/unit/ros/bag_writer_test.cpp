#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include "ros/bags/open_recording.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

RgbdFrame millimetreFrame(int index) {
  RgbdFrame frame = testFrame(index);
  frame.depth_unit_m = 0.001;
  return frame;
}

TEST(BagWriter, reads_back_what_was_written) {
  const TemporaryFolder folder;
  const std::string path = folder / "room.bag";
  const auto writer = createBag(path);
  for (int i = 0; i < 4; ++i) {
    RgbdFrame frame = millimetreFrame(i);
    if (i == 1) frame.color.release();
    if (i == 2) frame.color = randomColor(2, CV_8UC1);
    writer->write(frame);
  }
  writer->finish();
  const auto recording = openRecording(path, {});
  EXPECT_EQ(recording->frameCount(), 4u);
  for (int i = 0; i < 4; ++i) {
    const RgbdFrame written = millimetreFrame(i);
    const auto read = recording->next();
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->stamp_s, written.stamp_s);
    EXPECT_DOUBLE_EQ(read->depth_unit_m, 0.001);
    EXPECT_TRUE(sameImage(read->depth, written.depth));
    expectSameIntrinsics(read->intrinsics, written.intrinsics);
    if (i == 1) {
      EXPECT_TRUE(read->color.empty());
    } else {
      EXPECT_TRUE(sameImage(read->color, i == 2 ? randomColor(2, CV_8UC1) : written.color));
    }
  }
  EXPECT_FALSE(recording->next().has_value());
  EXPECT_FALSE(recording->next().has_value());
}

TEST(BagWriter, writes_millimetres_and_reference_poses) {
  const TemporaryFolder folder;
  const std::string path = folder / "room.bag";
  RgbdFrame frame = testFrame(0);
  frame.depth.at<uint16_t>(1, 1) = 5003;
  frame.T_W_D = Pose(Eigen::Translation3d(1.0, 2.0, 3.0) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  const auto writer = createBag(path);
  writer->write(frame);
  writer->finish();
  EXPECT_EQ(openBag(path, {})->next()->depth.at<uint16_t>(1, 1), 1001);
  const rosbag::Bag bag(path);
  rosbag::View view(bag, rosbag::TopicQuery("/tf"));
  ASSERT_EQ(view.size(), 1u);
  const auto transform = view.begin()->instantiate<tf2_msgs::TFMessage>()->transforms.at(0);
  EXPECT_EQ(transform.header.frame_id, "world");
  EXPECT_EQ(transform.child_frame_id, "camera_rgb_optical_frame");
  EXPECT_EQ(transform.header.stamp.toSec(), frame.stamp_s);
  EXPECT_EQ(transform.transform.translation.y, 2.0);
  EXPECT_NEAR(transform.transform.rotation.z, std::sin(0.25), 1e-12);
  EXPECT_NEAR(transform.transform.rotation.w, std::cos(0.25), 1e-12);
}

TEST(BagWriter, writes_recordings_that_begin_at_zero) {
  const TemporaryFolder folder;
  const std::string path = folder / "room.bag";
  const auto writer = createBag(path);
  RgbdFrame frame = millimetreFrame(0);
  frame.stamp_s = 0.0;
  writer->write(frame);
  frame.stamp_s = -1.0;
  expectError([&] { writer->write(frame); }, {"-1.0"});
  writer->finish();
  EXPECT_NEAR(openBag(path, {})->next()->stamp_s, 0.0, 2e-9);
}

TEST(BagWriter, says_when_it_cannot_write) {
  const TemporaryFolder folder;
  expectError([&] { createBag(folder / "no/room.bag"); }, {folder / "no/room.bag", "cannot be written"});
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const std::string path = folder / "full.bag";
  fs::create_symlink("/dev/full", path);
  expectError(
      [&] {
        const auto writer = createBag(path);
        for (int i = 0; i < 20000; ++i) writer->write(millimetreFrame(i));
        writer->finish();
      },
      {path, "cannot be written"});
}

TEST(BagWriter, refuses_to_overwrite_a_bag) {
  const TemporaryFolder folder;
  const std::string path = folder / "room.bag";
  createBag(path)->finish();
  const auto size = fs::file_size(path);
  expectError([&] { createBag(path); }, {path, "already exists", "another name"});
  EXPECT_EQ(fs::file_size(path), size);
}

}  // namespace
}  // namespace depth_fusion
