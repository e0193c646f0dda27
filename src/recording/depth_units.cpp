#include "recording/depth_units.h"

#include <cstdint>
#include <limits>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

cv::Mat convertDepthUnit(const cv::Mat& depth, double from_m, double to_m) {
  check(depth.type() == CV_16UC1, "a recording is written from depth of 16 bits (CV_16UC1), not of type " +
                                      cv::typeToString(depth.type()));
  if (from_m == to_m) return depth;
  cv::Mat scaled;
  depth.convertTo(scaled, CV_64F, from_m / to_m);
  scaled.setTo(0.0, scaled > std::numeric_limits<uint16_t>::max());
  cv::Mat converted;
  scaled.convertTo(converted, CV_16U);
  return converted;
}

}  // namespace depth_fusion
