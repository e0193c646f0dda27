// What of a frame's depth is in range, on the host.
#pragma once

#include <opencv2/core.hpp>

#include "depth_fusion/preprocessing/depth_preprocessor.h"

namespace depth_fusion {

// Where the depth in range is, as a mask.
inline cv::Mat depthInRange(const RgbdFrame& frame, const PreprocessingParameters& parameters) {
  cv::Mat mask;
  cv::inRange(frame.depth, parameters.min_range_m / frame.depth_unit_m,
              parameters.max_range_m / frame.depth_unit_m, mask);
  return mask;
}

// The window's middle lies ahead of the camera, at the mean depth of what it sees first.
inline Eigen::Vector3d windowCentre(const RgbdFrame& frame, const PreprocessingParameters& parameters,
                                    const Pose& T_W_D) {
  const double ahead_m = frame.depth_unit_m * cv::mean(frame.depth, depthInRange(frame, parameters))[0];
  return T_W_D * Eigen::Vector3d(0.0, 0.0, ahead_m);
}

}  // namespace depth_fusion
