// What plots have in common.
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

namespace depth_fusion {

const cv::Scalar kInk(50, 50, 50), kGrid(228, 228, 228);

inline void writeCentred(cv::Mat& canvas, const std::string& text, const cv::Point& centre,
                         double size = 0.45) {
  int baseline = 0;
  const cv::Size extent = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &baseline);
  cv::putText(canvas, text, centre + cv::Point(-extent.width / 2, extent.height / 2),
              cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

}  // namespace depth_fusion
