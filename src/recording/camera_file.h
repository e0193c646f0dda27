// Camera files: camera.yaml, what the TUM layout leaves unsaid (width, height, fx, fy, cx, cy and
// depth_scale, values a metre), or a calibration as ROS's camera_calibration writes it (image_width,
// camera_matrix, distortion_model, ...), with the pose of a colour camera, depth_to_color, if need be.
#pragma once

#include <optional>
#include <string>

#include "depth_fusion/geometry/lens_distortion.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

constexpr double kTumDepthScale = 5000.0;

struct CameraFile {
  CameraIntrinsics camera;
  std::optional<double> depth_scale;  // kTumDepthScale if the file does not say it
  LensDistortion distortion;
  std::optional<Pose> T_C_D;  // of a colour camera, where the file says it
};

// Throws Error naming the file and the key that is missing, unknown or not as it should be.
CameraFile readCameraFile(const std::string& path);

// Throws Error if the file cannot be written completely.
void writeCameraFile(const std::string& path, const CameraFile& file);

}  // namespace depth_fusion
