// The paper's memory figure.
#pragma once

#include <opencv2/core.hpp>

#include "tools/evaluation/resolution_plan.h"

namespace depth_fusion {

// Draws a bar for the bytes of each row, over N/M, which is red where it is over the limit, as CV_8UC3 BGR.
// Throws Error without rows.
cv::Mat plotMemory(const ResolutionPlan& plan);

}  // namespace depth_fusion
