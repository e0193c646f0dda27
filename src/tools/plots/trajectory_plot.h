// A picture of an estimated trajectory beside the true one.
#pragma once

#include <opencv2/core.hpp>

#include "tools/evaluation/trajectory_error.h"

namespace depth_fusion {

// Draws the top view (x, y) and the side view (x, z) in metres, coloured by the distance between both
// trajectories, as CV_8UC3 BGR.
cv::Mat plotTrajectories(const TrajectoryError& error);

}  // namespace depth_fusion
