// What of a frame's depth is in range, on the host.
#pragma once

#include <opencv2/core.hpp>

#include "depth_fusion/preprocessing/depth_preprocessor.h"

namespace depth_fusion {

// Where the depth in range is, as a mask.
inline cv::Mat depthInRange(const RgbdFrame& frame, const PreprocessingParameters& parameters) {
  cv::Mat mask;
  cv::inRange(frame.depth, parameters.min_range_m / frame.depth_unit_m, parameters.max_range_m / frame.depth_unit_m,
              mask);
  return mask;
}

}  // namespace depth_fusion
