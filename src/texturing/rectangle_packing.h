// Rectangles side by side on pages.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace depth_fusion {

struct PagePlace {
  size_t page = 0;
  cv::Point corner;  // top left
};

struct RectanglePacking {
  std::vector<PagePlace> places;  // of each rectangle
  std::vector<cv::Size> pages;    // cut to what is used
};

// Places the rectangles on pages of page_px squared at most, larger only where one of them is: the tallest
// first, each as high up as it goes, by the line that those before it reach down to.
RectanglePacking packed(const std::vector<cv::Size>& rectangles, int page_px);

}  // namespace depth_fusion
