// Single pixels of depth images, on the host.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "depth_fusion/frames/rgbd_frame.h"

namespace depth_fusion {

// In metres; 0 or NaN: none.
inline double depthAt_m(const RgbdFrame& frame, int x, int y) {
  const cv::Mat& depth = frame.depth;
  return frame.depth_unit_m * (depth.type() == CV_16UC1 ? depth.at<uint16_t>(y, x) : depth.at<float>(y, x));
}

inline void clearDepth(cv::Mat& depth, int x, int y) {
  if (depth.type() == CV_16UC1) {
    depth.at<uint16_t>(y, x) = 0;
  } else {
    depth.at<float>(y, x) = 0.0f;
  }
}

// The point that a pixel of a pinhole camera sees, in the camera's frame.
inline Eigen::Vector3d pointAt(const CameraIntrinsics& camera, int x, int y, double depth_m) {
  return {depth_m * (x - camera.cx) / camera.fx, depth_m * (y - camera.cy) / camera.fy, depth_m};
}

}  // namespace depth_fusion
