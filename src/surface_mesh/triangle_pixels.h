// The pixels of triangles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

namespace depth_fusion {

// Returns twice the area of the triangle a, b, p. It is positive for a triangle that is clockwise in the
// picture, where v points down.
inline float twiceTheArea(const cv::Point2f& a, const cv::Point2f& b, const cv::Point2f& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

// Calls action(pixel, weights of the corners, which sum up to 1) for each pixel of a picture of that size
// whose centre lies in the triangle, or at most `slack_px` beside it.
template <class Action>
void forEachPixelOf(const std::array<cv::Point2f, 3>& t, const cv::Size& size, float slack_px,
                    const Action& action) {
  const float whole = twiceTheArea(t[0], t[1], t[2]);
  if (whole == 0.0f) return;
  const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
  const auto [top, bottom] = std::minmax({t[0].y, t[1].y, t[2].y});
  const float last_x = std::min(right + slack_px, static_cast<float>(size.width - 1));
  const float last_y = std::min(bottom + slack_px, static_cast<float>(size.height - 1));
  if (left - slack_px > last_x || top - slack_px > last_y) return;
  std::array<float, 3> least{};
  if (slack_px > 0.0f) {
    for (int i = 0; i < 3; ++i) {
      const cv::Point2f edge = t[(i + 2) % 3] - t[(i + 1) % 3];
      least[i] = -slack_px * std::hypot(edge.x, edge.y) / std::abs(whole);
    }
  }
  for (auto y = static_cast<int>(std::ceil(std::max(top - slack_px, 0.0f))); static_cast<float>(y) <= last_y;
       ++y) {
    for (auto x = static_cast<int>(std::ceil(std::max(left - slack_px, 0.0f)));
         static_cast<float>(x) <= last_x; ++x) {
      const cv::Point2f p(static_cast<float>(x), static_cast<float>(y));
      const float w0 = twiceTheArea(t[1], t[2], p) / whole;
      const float w1 = twiceTheArea(t[2], t[0], p) / whole;
      const float w2 = 1.0f - w0 - w1;
      if (w0 >= least[0] && w1 >= least[1] && w2 >= least[2])
        action(cv::Point(x, y), std::array<float, 3>{w0, w1, w2});
    }
  }
}

}  // namespace depth_fusion
