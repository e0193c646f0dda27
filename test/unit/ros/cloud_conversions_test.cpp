// Point clouds as images of depth and colour.
#include "ros/conversions/cloud_conversions.h"

#include <gtest/gtest.h>

#include "support/cloud_messages.h"
#include "support/expect_error.h"
#include "support/simulated_frames.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

RgbdFrame roomFrame() {
  SimulationOptions options;
  options.frames = 1;
  options.intrinsics = {320, 240, 262.5, 270.0, 161.5, 117.25};
  return *SimulatedRecording(options).next();
}

cv::Mat zeroForNone(const cv::Mat& depth) {
  cv::Mat result = depth.clone();
  cv::patchNaNs(result, 0.0);
  return result;
}

TEST(Clouds, OrganisedOnesAreTheImagesOfTheirCamera) {
  const RgbdFrame frame = roomFrame();
  const auto cloud = cloudOf({}, frame);
  ASSERT_TRUE(isOrganised(*cloud));
  const CameraIntrinsics camera = cameraOfCloud(*cloud, "/points");
  EXPECT_EQ(camera.width, 320);
  EXPECT_EQ(camera.height, 240);
  EXPECT_NEAR(camera.fx, 262.5, 0.01);
  EXPECT_NEAR(camera.fy, 270.0, 0.01);
  EXPECT_NEAR(camera.cx, 161.5, 0.01);
  EXPECT_NEAR(camera.cy, 117.25, 0.01);
  EXPECT_TRUE(isCameraOf(camera, *cloud, "/points"));
  CameraIntrinsics other = camera;
  other.fx += 5.0;
  EXPECT_FALSE(isCameraOf(other, *cloud, "/points"));
  EXPECT_FALSE(isCameraOf(CameraIntrinsics(), *cloud, "/points"));
  EXPECT_EQ(cv::norm(zeroForNone(depthOfCloud(*cloud, "/points")), frame.depth, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(colorOfCloud(*cloud), frame.color, cv::NORM_INF), 0.0);
}

TEST(Clouds, ListsAreProjectedAndTheNearestPointCounts) {
  const RgbdFrame frame = roomFrame();
  auto list = asList(*cloudOf({}, frame));
  EXPECT_FALSE(isOrganised(*list));
  const cv::Mat depth = zeroForNone(depthOfPoints(*list, frame.intrinsics, "/points"));
  EXPECT_EQ(cv::norm(depth, frame.depth, cv::NORM_INF), 0.0);
  const CameraIntrinsics half = halved(frame.intrinsics);
  const cv::Mat coarse = zeroForNone(depthOfPoints(*list, half, "/points"));
  float nearest = 100.0f;
  for (int i = 0; i < 4; ++i) nearest = std::min(nearest, frame.depth.at<float>(120 + i / 2, 160 + i % 2));
  EXPECT_FLOAT_EQ(coarse.at<float>(60, 80), nearest);
}

TEST(Clouds, IntensityIsGreyWhereThereIsNoColour) {
  auto cloud = cloudOf({}, roomFrame());
  cloud->fields[3].name = "intensity";
  const float values[] = {-3.0f, 100.4f, 4000.0f};
  for (size_t i = 0; i < 3; ++i) std::memcpy(cloud->data.data() + 32 * i + 16, &values[i], 4);
  const cv::Mat grey = colorOfCloud(*cloud);
  ASSERT_EQ(grey.type(), CV_8UC1);
  EXPECT_EQ(grey.at<uint8_t>(0, 0), 0);
  EXPECT_EQ(grey.at<uint8_t>(0, 1), 100);
  EXPECT_EQ(grey.at<uint8_t>(0, 2), 255);
  cloud->fields.pop_back();
  EXPECT_TRUE(colorOfCloud(*cloud).empty());
}

TEST(Clouds, SayWhatIsWrongWithThem) {
  const RgbdFrame frame = roomFrame();
  const auto good = cloudOf({}, frame);
  auto cloud = *good;
  cloud.data.resize(cloud.data.size() / 2);
  expectError([&] { depthOfCloud(cloud, "/points"); }, {"/points", "truncated"});
  cloud = *good;
  cloud.fields[2].name = "depth";
  expectError([&] { depthOfCloud(cloud, "/points"); }, {"/points", "no field z"});
  cloud = *good;
  cloud.is_bigendian = true;
  expectError([&] { depthOfCloud(cloud, "/points"); }, {"/points", "big-endian"});
  cloud = *good;
  std::swap(cloud.fields[0].name, cloud.fields[2].name);  // a frame whose x points forward
  expectError([&] { cameraOfCloud(cloud, "/points"); }, {"/points", "optical frame"});
  RgbdFrame blind = frame;
  blind.depth.setTo(0.0);
  expectError([&] { cameraOfCloud(*cloudOf({}, blind), "/points"); }, {"/points", "0 points"});
}

}  // namespace
}  // namespace depth_fusion
