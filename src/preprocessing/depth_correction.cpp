#include "depth_fusion/preprocessing/depth_correction.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr int kMaxGridSize = 100;
constexpr float kMaxOffset_per_m = 0.5f;

[[noreturn]] void refuse(const std::string& why) {
  throw Error("parameter 'preprocessing/depth_offsets_per_m' " + why +
              "; it holds columns, rows and an offset for each, as calibrate writes them, or nothing");
}

}  // namespace

GridPlace placeOnGrid(double x, double y, cv::Size image, cv::Size grid) {
  const double column = std::clamp((x + 0.5) / image.width, 0.0, 1.0) * (grid.width - 1);
  const double row = std::clamp((y + 0.5) / image.height, 0.0, 1.0) * (grid.height - 1);
  const int left = std::min(static_cast<int>(column), grid.width - 2);
  const int top = std::min(static_cast<int>(row), grid.height - 2);
  const double right_part = column - left, bottom_part = row - top;
  const int first = top * grid.width + left;
  return {{first, first + 1, first + grid.width, first + grid.width + 1},
          {(1.0 - right_part) * (1.0 - bottom_part), right_part * (1.0 - bottom_part),
           (1.0 - right_part) * bottom_part, right_part * bottom_part}};
}

cv::Mat spreadOffsets(const cv::Mat& grid, cv::Size image) {
  cv::Mat offsets(image, CV_32FC1);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const GridPlace place = placeOnGrid(x, y, image, grid.size());
      double offset = 0.0;
      for (int i = 0; i < 4; ++i) offset += place.parts[i] * grid.ptr<float>()[place.indices[i]];
      offsets.at<float>(y, x) = static_cast<float>(offset);
    }
  }
  return offsets;
}

cv::Mat parseDepthOffsets(const std::string& text) {
  std::istringstream stream(text);
  if ((stream >> std::ws).eof()) return {};
  int columns = 0, rows = 0;
  if (!(stream >> columns >> rows)) refuse("does not begin with two numbers");
  if (std::min(columns, rows) < 2 || std::max(columns, rows) > kMaxGridSize) {
    refuse("has a grid of " + std::to_string(columns) + " x " + std::to_string(rows));
  }
  cv::Mat grid(rows, columns, CV_32FC1);
  for (float& offset : cv::Mat_<float>(grid)) {
    if (!(stream >> offset))
      refuse("has fewer than " + std::to_string(grid.total()) + " offsets, or one is no number");
    if (!(std::abs(offset) <= kMaxOffset_per_m)) refuse("has an offset outside of [-0.5, 0.5]");
  }
  if (!(stream >> std::ws).eof()) refuse("has more than " + std::to_string(grid.total()) + " offsets");
  return grid;
}

std::string depthOffsetsText(const cv::Mat& grid) {
  if (grid.empty()) return {};
  std::string text = std::to_string(grid.cols) + " " + std::to_string(grid.rows);
  for (const float offset : cv::Mat_<float>(grid)) {
    char number[32];
    std::snprintf(number, sizeof(number), " %.5f", offset);
    text += number;
  }
  return text;
}

}  // namespace depth_fusion
