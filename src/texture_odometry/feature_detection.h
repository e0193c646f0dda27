// Corners spread over the image, with BRIEF descriptors.
#pragma once

#include "depth_fusion/texture_odometry/texture_odometry.h"

namespace depth_fusion {

// Finds the features of an image CV_8UC3 (BGR) or CV_8UC1, without their surfaces.
void detectFeatures(const cv::Mat& color, const TextureOdometryParameters& parameters, FrameFeatures& result);

}  // namespace depth_fusion
