// Depth in other units.
#pragma once

#include <opencv2/core.hpp>

namespace depth_fusion {

// CV_16UC1 depth in units of from_m as CV_16UC1 in units of to_m, rounded to nearest; what 16 bits cannot
// hold becomes 0, no depth.
cv::Mat convertDepthUnit(const cv::Mat& depth, double from_m, double to_m);

}  // namespace depth_fusion
