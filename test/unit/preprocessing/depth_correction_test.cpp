#include "depth_fusion/preprocessing/depth_correction.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"

namespace depth_fusion {
namespace {

TEST(DepthCorrection, TextHoldsTheGrid) {
  const cv::Mat grid = (cv::Mat_<float>(2, 3) << 0.01f, -0.02f, 0.0f, 0.12345f, 0.5f, -0.5f);
  const std::string text = depthOffsetsText(grid);
  EXPECT_EQ(text, "3 2 0.01000 -0.02000 0.00000 0.12345 0.50000 -0.50000");
  const cv::Mat read = parseDepthOffsets(text);
  ASSERT_EQ(read.size(), grid.size());
  EXPECT_LT(cv::norm(read, grid, cv::NORM_INF), 1e-6);
  EXPECT_TRUE(parseDepthOffsets("").empty());
  EXPECT_TRUE(parseDepthOffsets("  ").empty());
  EXPECT_EQ(depthOffsetsText(cv::Mat()), "");
}

TEST(DepthCorrection, RefusesOtherTexts) {
  expectError([] { parseDepthOffsets("eight"); }, {"depth_offsets_per_m", "two numbers", "calibrate"});
  expectError([] { parseDepthOffsets("1 2 0 0"); }, {"grid of 1 x 2"});
  expectError([] { parseDepthOffsets("1000000 1000000 0"); }, {"grid of 1000000"});
  expectError([] { parseDepthOffsets("2 2 0 0 0"); }, {"fewer than 4"});
  expectError([] { parseDepthOffsets("2 2 0 0 0 x"); }, {"fewer than 4"});
  expectError([] { parseDepthOffsets("2 2 0 0 0 0 0"); }, {"more than 4"});
  expectError([] { parseDepthOffsets("2 2 0 0 0 0.6"); }, {"outside"});
  expectError([] { parseDepthOffsets("2 2 0 0 0 nan"); }, {"offset"});
}

TEST(DepthCorrection, IsBilinearBetweenTheImagesCorners) {
  const cv::Mat grid = (cv::Mat_<float>(2, 3) << 0.0f, 0.1f, 0.2f, 0.2f, 0.3f, 0.4f);  // 0.2 x + 0.2 y
  for (const cv::Size size : {cv::Size(640, 480), cv::Size(31, 17)}) {
    const cv::Mat offsets = spreadOffsets(grid, size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const double expected = 0.2 * (x + 0.5) / size.width + 0.2 * (y + 0.5) / size.height;
        ASSERT_NEAR(offsets.at<float>(y, x), expected, 1e-6) << x << " " << y;
      }
    }
  }
}

}  // namespace
}  // namespace depth_fusion
