// Bags whose depth is in clouds.
#include <filesystem>

#include "ros/bags/open_recording.h"
#include "support/bag_fixture.h"
#include "support/cloud_messages.h"
#include "support/expect_error.h"
#include "support/real_data.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

constexpr char kCloudTopic[] = "/camera/depth_registered/points";

RgbdFrame roomFrame() {
  SimulationOptions options;
  options.frames = 1;
  options.intrinsics = {320, 240, 262.5, 262.5, 159.5, 119.5};
  return *SimulatedRecording(options).next();
}

class BagClouds : public BagTest {};

TEST_F(BagClouds, OrganisedOnesAreFramesWithTheirColour) {
  const RgbdFrame expected = roomFrame();
  const std::string path = makeBag([&](rosbag::Bag& bag) {
    for (const double stamp_s : {1.0, 1.1}) {
      const auto cloud = cloudOf({}, expected);
      addToBag(bag, kCloudTopic, stamp_s, *cloud);
    }
  });
  const auto recording = openBag(path, {});
  EXPECT_EQ(recording->frameCount(), 2u);
  EXPECT_NE(recording->description().find("from the points of"), std::string::npos)
      << recording->description();
  const auto frame = recording->next();
  ASSERT_TRUE(frame.has_value());
  EXPECT_NEAR(frame->intrinsics.fx, 262.5, 0.01);
  cv::Mat depth = frame->depth.clone();
  cv::patchNaNs(depth, 0.0);
  EXPECT_EQ(cv::norm(depth, expected.depth, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(frame->color, expected.color, cv::NORM_INF), 0.0);
}

TEST_F(BagClouds, ListsAreRefused) {
  const std::string path =
      makeBag([&](rosbag::Bag& bag) { addToBag(bag, kCloudTopic, 1.0, *asList(*cloudOf({}, roomFrame()))); });
  expectError([&] { openBag(path, {}); }, {kCloudTopic, "list of points"});
}

TEST_F(BagClouds, ARealOneIsRead) {
  const std::string path = realDataFolder("pointcloud2_bag") + "/perception_tutorial.bag";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  const auto recording = openBag(path, {});
  const auto frame = recording->next();
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->depth.cols, frame->intrinsics.width);
  EXPECT_EQ(frame->color.size(), frame->depth.size());
  EXPECT_NEAR(frame->intrinsics.fx, frame->intrinsics.fy, 3.0);
  EXPECT_GT(cv::countNonZero(frame->depth > 0.3f), frame->depth.rows * frame->depth.cols / 2);
}

}  // namespace
}  // namespace depth_fusion
