#include "tools/plots/line_plot.h"

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
  const cv::Rect left_half(70, 130, 300, 280);  // below the legend
  EXPECT_GT(cv::countNonZero(first(left_half)), 250);
  EXPECT_GT(cv::countNonZero(second(left_half)), 250);
  EXPECT_EQ(cv::boundingRect(first(left_half)).height, 3) << "the level line";
  EXPECT_GT(cv::boundingRect(second(left_half)).height, 100) << "the rising line";
}

// Rows of the line's pixels at a part of the frame's width.
int rowAt(const cv::Mat& picture, double part) {
  cv::Mat line;
  cv::inRange(picture, cv::Scalar(180, 120, 30), cv::Scalar(180, 120, 30), line);
  const cv::Rect column(70 + static_cast<int>(part * 640), 120, 1, 290);
  const cv::Rect box = cv::boundingRect(line(column));
  EXPECT_GT(box.height, 0);
  return 120 + box.y + box.height / 2;
}

TEST(LinePlot, PowersAreStraightOnLogarithmicAxes) {
  PlotLine power{"power", {}};
  for (double x = 100.0; x <= 100000.0; x *= 1.3) power.points.emplace_back(x, 1e-6 * x * x);
  const cv::Mat picture = draw({"title", "x", "y", {power}, true});
  const int at_quarter = rowAt(picture, 0.25), at_half = rowAt(picture, 0.5), at_three = rowAt(picture, 0.7);
  EXPECT_GT(at_quarter, at_half + 50);
  EXPECT_NEAR((at_quarter - at_half) / 0.25, (at_half - at_three) / 0.2, 20.0);
  expectError([] { draw({"", "", "", {{"zero", {{0.0, 1.0}, {1.0, 1.0}}}}, true}); }, {"positive"});
}

TEST(LinePlot, RefusesNothing) {
  expectError([] { draw({"", "", "", {{"empty", {}}}}); }, {"nothing to plot"});
}

}  // namespace
}  // namespace depth_fusion
