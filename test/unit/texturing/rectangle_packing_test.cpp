#include "texturing/rectangle_packing.h"

#include <gtest/gtest.h>

#include <random>

namespace depth_fusion {
namespace {

std::vector<cv::Size> someRectangles(size_t count, int largest) {
  std::mt19937 random(1);
  std::vector<cv::Size> rectangles;
  for (size_t i = 0; i < count; ++i) {
    const auto side = [&] { return 1 + static_cast<int>(random() % static_cast<unsigned>(largest)); };
    const int width = side();
    rectangles.emplace_back(width, side());
  }
  return rectangles;
}

// How full the pages are.
double expectApart(const std::vector<cv::Size>& rectangles, const RectanglePacking& packing) {
  std::vector<cv::Mat> pages;
  for (const cv::Size& size : packing.pages) pages.push_back(cv::Mat::zeros(size, CV_8U));
  EXPECT_EQ(packing.places.size(), rectangles.size());
  double used = 0.0, all = 0.0;
  for (size_t i = 0; i < rectangles.size(); ++i) {
    cv::Mat& page = pages.at(packing.places[i].page);
    const cv::Rect place(packing.places[i].corner, rectangles[i]);
    EXPECT_EQ(place & cv::Rect({0, 0}, page.size()), place);
    EXPECT_EQ(cv::countNonZero(page(place)), 0) << i;
    page(place) = 1;
    used += place.area();
  }
  for (const cv::Mat& page : pages) all += static_cast<double>(page.total());
  return used / all;
}

TEST(RectanglePacking, rectanglesLieApartOnAFullPage) {
  const std::vector<cv::Size> rectangles = someRectangles(1000, 60);
  const RectanglePacking packing = packed(rectangles, 4096);
  EXPECT_EQ(packing.pages.size(), 1u);
  EXPECT_GT(expectApart(rectangles, packing), 0.85);
}

TEST(RectanglePacking, morePagesWhereOneIsNotEnough) {
  const std::vector<cv::Size> rectangles = someRectangles(1000, 60);
  const RectanglePacking packing = packed(rectangles, 400);
  EXPECT_GT(packing.pages.size(), 5u);
  EXPECT_GT(expectApart(rectangles, packing), 0.8);
  for (const cv::Size& page : packing.pages) EXPECT_LE(std::max(page.width, page.height), 400);
}

TEST(RectanglePacking, whatIsLargerThanAPageMakesItLarger) {
  const std::vector<cv::Size> rectangles = {{500, 10}, {10, 700}, {3, 3}};
  const RectanglePacking packing = packed(rectangles, 256);
  expectApart(rectangles, packing);
  EXPECT_TRUE(packed({}, 256).pages.empty());
}

}  // namespace
}  // namespace depth_fusion
