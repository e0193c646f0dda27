// A picture of a depth calibration.
#pragma once

#include "tools/calibration/depth_calibration.h"

namespace depth_fusion {

// Draws, over the image, the systematic error before and after, and the correction, as CV_8UC3 BGR.
cv::Mat drawCalibration(const DepthCalibration& calibration);

}  // namespace depth_fusion
