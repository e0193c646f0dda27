// The camera that a driver's field of view stands for.
#pragma once

#include <cmath>

#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

// Assumes square pixels and the axis in the middle, as openni2_camera does. An angle of 0 gives no focal
// length.
inline CameraIntrinsics cameraFromFieldOfView(int width, int height, double horizontal_rad) {
  const double focal_px = horizontal_rad > 0.0 ? 0.5 * width / std::tan(0.5 * horizontal_rad) : 0.0;
  return {width, height, focal_px, focal_px, 0.5 * (width - 1), 0.5 * (height - 1)};
}

}  // namespace depth_fusion
