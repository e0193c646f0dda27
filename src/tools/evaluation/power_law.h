// How a cost grows with what causes it.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace depth_fusion {

// Returns the exponent b of the power law y = a * x^b that fits the points best (least squares of the
// logarithms): 0 for a constant, 1 for a line through the origin. Throws Error without two different x or
// with a number that is not positive.
double powerLawExponent(const std::vector<cv::Point2d>& points);

}  // namespace depth_fusion
