#include "depth_fusion/evaluation/line_plot.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/expect_error.h"

namespace depth_fusion {
namespace {

TEST(LinePlot, ShowsEachLineInItsColour) {
  const LinePlot plot{
      "title", "x", "y", {{"level", {{0.0, 1.0}, {10.0, 1.0}}}, {"rising", {{0.0, 0.0}, {10.0, 2.0}}}}};
  const cv::Mat picture = draw(plot);
  ASSERT_EQ(picture.type(), CV_8UC3);
  cv::Mat first, second;
  cv::inRange(picture, cv::Scalar(180, 120, 30), cv::Scalar(180, 120, 30), first);
  cv::inRange(picture, cv::Scalar(40, 120, 240), cv::Scalar(40, 120, 240), second);
  const cv::Rect left_half(70, 130, 300, 280);  // without the legend
  EXPECT_GT(cv::countNonZero(first(left_half)), 250);
  EXPECT_GT(cv::countNonZero(second(left_half)), 250);
  EXPECT_EQ(cv::boundingRect(first(left_half)).height, 3) << "the level line";
  EXPECT_GT(cv::boundingRect(second(left_half)).height, 100) << "the rising line";
}

TEST(LinePlot, RefusesNothing) {
  expectError([] { draw({"", "", "", {{"empty", {}}}}); }, {"nothing to plot"});
}

}  // namespace
}  // namespace depth_fusion
