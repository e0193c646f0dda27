#include "tools/evaluation/power_law.h"

#include <cmath>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

double powerLawExponent(const std::vector<cv::Point2d>& points) {
  cv::Point2d mean;
  for (const cv::Point2d& point : points) {
    check(point.x > 0.0 && point.y > 0.0, "a power law is fitted to positive numbers only");
    mean += cv::Point2d(std::log(point.x), std::log(point.y)) / static_cast<double>(points.size());
  }
  double spread = 0.0, slope = 0.0;
  for (const cv::Point2d& point : points) {
    const double x = std::log(point.x) - mean.x;
    spread += x * x;
    slope += x * (std::log(point.y) - mean.y);
  }
  check(spread > 0.0, "a power law is fitted to two points of different x, or more");
  return slope / spread;
}

}  // namespace depth_fusion
