// Camera files: camera.yaml, what the TUM layout leaves unsaid (width, height, fx, fy, cx, cy and depth_scale, values a
// metre), or a calibration as ROS's camera_calibration writes it (image_width, camera_matrix, distortion_model, ...).
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

constexpr double kTumDepthScale = 5000.0;

struct CameraFile {
  CameraIntrinsics camera;
  double depth_scale = kTumDepthScale;
  std::vector<double> distortion;  // k1 k2 p1 p2 [k3 [k4 k5 k6]], OpenCV's order; empty: none
};

// Throws Error naming the file and the key that is missing, unknown or not as it should be.
CameraFile readCameraFile(const std::string& path);

// Throws Error if the file cannot be written completely.
void writeCameraFile(const std::string& path, const CameraFile& file);

}  // namespace depth_fusion
