#include "depth_fusion/relocalisation/keyframe_view.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/simulated_frames.h"

namespace depth_fusion {
namespace {

const CameraIntrinsics kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

TEST(KeyframeView, DepthComesBackInQuartersOfAMillimetre) {
  cv::Mat depth_m(240, 320, CV_32FC1);
  cv::randu(depth_m, 0.1, 16.0);
  depth_m.at<float>(10, 10) = 0.0f;
  depth_m.at<float>(11, 10) = 17.0f;
  depth_m.at<float>(12, 10) = std::numeric_limits<float>::quiet_NaN();
  const KeyframeView view(depth_m, kCamera, 320);
  const cv::Mat back = KeyframeView(view.camera(), view.packed(), "row").depth();
  for (int i = 10; i < 13; ++i) EXPECT_EQ(back.at<float>(i, 10), 0.0f) << "no depth that can be kept: " << i;
  for (int i = 10; i < 13; ++i) depth_m.at<float>(i, 10) = 0.0f;
  EXPECT_LE(cv::norm(back, depth_m, cv::NORM_INF), 0.00013);
}

TEST(KeyframeView, IsHalvedToTheWidthWithoutMixingSurfaces) {
  cv::Mat depth_m(240, 320, CV_32FC1, cv::Scalar(3.0));
  depth_m.colRange(0, 101) = 1.0;
  const KeyframeView view(depth_m, kCamera, 160);
  EXPECT_EQ(view.camera().width, 160);
  const cv::Mat small = view.depth();
  ASSERT_EQ(small.size(), cv::Size(160, 120));
  EXPECT_FLOAT_EQ(small.at<float>(60, 50), 1.0f) << "the pixel at the edge is of the nearer surface";
  EXPECT_FLOAT_EQ(small.at<float>(60, 51), 3.0f);
}

TEST(KeyframeView, ARoomTakesLittle) {
  SimulationOptions options;
  options.noise = false;  // as a fused surface
  SimulatedRecording recording(options);
  const RgbdFrame frame = *recording.next();
  EXPECT_LT(KeyframeView(frame.depth, frame.intrinsics, 320).packed().size(), 100000u);
  EXPECT_LT(KeyframeView(frame.depth, frame.intrinsics, 160).packed().size(), 30000u);
}

TEST(KeyframeView, WhatIsDamagedIsRefused) {
  const KeyframeView view(cv::Mat(240, 320, CV_32FC1, cv::Scalar(1.0)), kCamera, 320);
  expectError([&] { KeyframeView(halved(kCamera), view.packed(), "row 7"); }, {"row 7", "size"});
  expectError([&] { KeyframeView(kCamera, view.packed().substr(0, 30), "row 7"); }, {"row 7"});
  expectError([&] { KeyframeView(cv::Mat(24, 32, CV_32FC1), kCamera, 320); }, {"32x24", "320x240"});
  EXPECT_TRUE(KeyframeView().isEmpty());
}

}  // namespace
}  // namespace depth_fusion
