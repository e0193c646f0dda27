// camera.yaml, what the TUM layout leaves unsaid: width, height, fx, fy, cx, cy and depth_scale (values a
// metre).
#pragma once

#include <string>

#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

constexpr double kTumDepthScale = 5000.0;

struct CameraFile {
  CameraIntrinsics camera;
  double depth_scale = kTumDepthScale;
};

// depth_scale may be left out. Throws Error naming the file and the key that is missing, unknown or not a
// number.
CameraFile readCameraFile(const std::string& path);

// Throws Error if the file cannot be written completely.
void writeCameraFile(const std::string& path, const CameraFile& file);

}  // namespace depth_fusion
