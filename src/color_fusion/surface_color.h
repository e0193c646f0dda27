// What the map, and what an image, say about the colour of the surface.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// A point of the surface and its colour in the map.
struct SurfaceColor {
  Eigen::Vector3d p_W;
  Eigen::Array3d bgr;
  double weight = 0.0;  // of the colour, 0 to 255
};

struct ColorImage {
  CameraIntrinsics camera;
  cv::Mat bgra;  // CV_8UC4; the last channel means nothing here
};

}  // namespace depth_fusion
