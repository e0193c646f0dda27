#include "texturing/rectangle_packing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

namespace depth_fusion {
namespace {

// A page whose rectangles reach down to a line of steps.
class Page {
 public:
  explicit Page(const cv::Size& limit) : limit_(limit), steps_({{0, 0}}) {}

  // Returns nothing if there is no room.
  std::optional<cv::Point> place(const cv::Size& size) {
    cv::Point best(0, std::numeric_limits<int>::max());
    for (size_t i = 0; i < steps_.size() && steps_[i].x + size.width <= limit_.width; ++i) {
      const int y = lineBelow(i, size.width);
      if (y + size.height <= limit_.height && y < best.y) best = {steps_[i].x, y};
    }
    if (best.y == std::numeric_limits<int>::max()) return std::nullopt;
    lower(best.x, best.x + size.width, best.y + size.height);
    used_ = {std::max(used_.width, best.x + size.width), std::max(used_.height, best.y + size.height)};
    return best;
  }
  cv::Size used() const { return used_; }

 private:
  struct Step {
    int x, y;  // the line is at y from x to the next step
  };

  int endOf(size_t i) const { return i + 1 < steps_.size() ? steps_[i + 1].x : limit_.width; }

  int lineBelow(size_t first, int width) const {
    int y = 0;
    for (size_t i = first; i < steps_.size() && steps_[i].x < steps_[first].x + width; ++i)
      y = std::max(y, steps_[i].y);
    return y;
  }

  // The line is at y from left to right.
  void lower(int left, int right, int y) {
    std::vector<Step> steps;
    for (size_t i = 0; i < steps_.size(); ++i) {
      if (steps_[i].x < left) steps.push_back(steps_[i]);
      if (steps_[i].x <= left && left < endOf(i)) steps.push_back({left, y});
      if (endOf(i) > right) steps.push_back({std::max(steps_[i].x, right), steps_[i].y});
    }
    steps_ = std::move(steps);
  }

  cv::Size limit_, used_;
  std::vector<Step> steps_;
};

// A page that is about square, and no larger than needed.
cv::Size pageSize(const std::vector<cv::Size>& rectangles, int page_px) {
  constexpr double kLoss = 1.05;
  double area = 0.0;
  cv::Size largest(1, 1);
  for (const cv::Size& size : rectangles) {
    area += static_cast<double>(size.area());
    largest = {std::max(largest.width, size.width), std::max(largest.height, size.height)};
  }
  const int square = static_cast<int>(std::ceil(std::sqrt(kLoss * area)));
  return {std::max(largest.width, std::min(square, page_px)), std::max(largest.height, page_px)};
}

}  // namespace

RectanglePacking packed(const std::vector<cv::Size>& rectangles, int page_px) {
  std::vector<size_t> order(rectangles.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return rectangles[a].height > rectangles[b].height; });
  const cv::Size page_size = pageSize(rectangles, page_px);
  std::vector<Page> pages;
  RectanglePacking packing;
  packing.places.resize(rectangles.size());
  for (const size_t i : order) {
    std::optional<cv::Point> corner;
    size_t page = 0;
    for (; page < pages.size() && !corner; ++page) corner = pages[page].place(rectangles[i]);
    if (!corner) {
      pages.emplace_back(page_size);
      corner = pages.back().place(rectangles[i]);
      page = pages.size();
    }
    packing.places[i] = {page - 1, *corner};
  }
  for (const Page& page : pages) packing.pages.push_back(page.used());
  return packing;
}

}  // namespace depth_fusion
