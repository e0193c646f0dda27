// The size that most images have.
#pragma once

#include <algorithm>
#include <opencv2/core.hpp>
#include <vector>

namespace depth_fusion {

// Returns the most frequent size; of sizes that are equally frequent, the first. `sizes` must not be empty.
inline cv::Size usualSize(const std::vector<cv::Size>& sizes) {
  const auto count = [&](const cv::Size& size) { return std::count(sizes.begin(), sizes.end(), size); };
  return *std::max_element(sizes.begin(), sizes.end(),
                           [&](const cv::Size& a, const cv::Size& b) { return count(a) < count(b); });
}

}  // namespace depth_fusion
