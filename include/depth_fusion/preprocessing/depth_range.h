// The depth that is used of a frame.
#pragma once

#include <opencv2/core.hpp>

#include "depth_fusion/frames/rgbd_frame.h"
#include "depth_fusion/preprocessing/preprocessing_parameters.h"

namespace depth_fusion {

// Nearer and farther depth is left out by every stage.
struct DepthRange {
  float min_m;
  float max_m;
};

// The range that is asked for, as far as the sensor's noise allows.
DepthRange depthRange(const PreprocessingParameters& parameters, const DepthSensorParameters& sensor);

// A mask of the frame's pixels whose depth is in range.
cv::Mat depthInRange(const RgbdFrame& frame, const DepthRange& range);

// Where the window of a map that begins with this frame is to have its middle: ahead of the camera, at the
// mean depth of what is in range.
Eigen::Vector3d windowCentre(const RgbdFrame& frame, const DepthRange& range, const Pose& T_W_D);

}  // namespace depth_fusion
