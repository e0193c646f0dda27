// The systematic error of a depth sensor whose inverse depth is off by an amount that depends on the pixel,
// as it is where disparities are off by a fraction of a pixel (structured light, stereo).
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <string>

namespace depth_fusion {

// Depth offsets are offsets of the inverse depth (1/m), CV_32FC1, on a grid whose corners are those of the
// image; between its points they are bilinear. The depth z becomes z / (1 + z offset).

// Four entries of a grid, by their index row by row, and their parts.
struct GridPlace {
  std::array<int, 4> indices;
  std::array<double, 4> parts;
};

// Returns where the pixel (x, y) of an image of the given size lies on a grid of columns x rows, at least two
// each.
GridPlace placeOnGrid(double x, double y, cv::Size image, cv::Size grid);

// Returns the offset at every pixel.
cv::Mat spreadOffsets(const cv::Mat& grid, cv::Size image);

// Reads "columns rows offset offset ...", row by row; an empty text is an empty grid. Throws Error for any
// other text.
cv::Mat parseDepthOffsets(const std::string& text);
std::string depthOffsetsText(const cv::Mat& grid);

}  // namespace depth_fusion
