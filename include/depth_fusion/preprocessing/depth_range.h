// The pixels of a frame whose depth is in range.
#pragma once

#include <opencv2/core.hpp>

#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/preprocessing/preprocessing_parameters.h"

namespace depth_fusion {

// A mask of the frame's pixels whose depth is in range.
cv::Mat depthInRange(const RgbdFrame& frame, const DepthRange& range);

// Where the window of a map that begins with this frame is to have its middle: ahead of the camera, at the
// mean depth of what is in range.
Eigen::Vector3d windowCentre(const RgbdFrame& frame, const DepthRange& range, const Pose& T_W_D);

}  // namespace depth_fusion
