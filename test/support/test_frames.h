// Small frames with known contents, and comparisons of them.
#pragma once

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "depth_fusion/frames/rgbd_frame.h"

namespace depth_fusion {

constexpr int kTestWidth = 12;
constexpr int kTestHeight = 8;

inline cv::Mat randomDepth(int seed) {
  cv::Mat depth(kTestHeight, kTestWidth, CV_16UC1);
  cv::RNG(static_cast<uint64_t>(seed) + 1).fill(depth, cv::RNG::UNIFORM, 0, 10000);
  depth.at<uint16_t>(0, 0) = 0;
  return depth;
}

inline cv::Mat randomColor(int seed, int type = CV_8UC3) {
  cv::Mat color(kTestHeight, kTestWidth, type);
  cv::RNG(static_cast<uint64_t>(seed) + 1000).fill(color, cv::RNG::UNIFORM, 0, 256);
  return color;
}

inline RgbdFrame testFrame(int index) {
  RgbdFrame frame;
  frame.stamp_s = 1305031102.160407 + 0.0333 * index;
  frame.depth = randomDepth(index);
  frame.depth_unit_m = 1.0 / 5000.0;
  frame.color = randomColor(index);
  frame.intrinsics = {kTestWidth, kTestHeight, 10.1, 10.2, 5.5, 3.25};
  return frame;
}

inline bool sameImage(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size() || a.type() != b.type()) return false;
  return a.empty() || cv::norm(a, b, cv::NORM_INF) == 0.0;
}

inline void expectSameIntrinsics(const CameraIntrinsics& a, const CameraIntrinsics& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_DOUBLE_EQ(a.fx, b.fx);
  EXPECT_DOUBLE_EQ(a.fy, b.fy);
  EXPECT_DOUBLE_EQ(a.cx, b.cx);
  EXPECT_DOUBLE_EQ(a.cy, b.cy);
}

}  // namespace depth_fusion
