// What a sensor or a recording gives at one moment.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "depth_fusion/frames/motion_readings.h"
#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/lens_distortion.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

struct RgbdFrame {
  double stamp_s = 0.0;       // of the depth image
  std::string stamp_problem;  // why that is not the stamp that the recording has; empty if it is
  cv::Mat depth;  // CV_16UC1 in units of depth_unit_m, or CV_32FC1 in units of depth_unit_m; 0, NaN = none
  double depth_unit_m = 1.0;  // metres a unit of `depth` (0.001 for millimetres)
  cv::Mat weights;  // CV_32FC1 of the depth's size, or empty: how much fusion trusts each pixel, in (0, 1]; a
                    // pixel with any other weight, NaN among them, is not fused
  cv::Mat color;    // CV_8UC3 BGR or CV_8UC1, or empty; nearest in time to `depth`
  std::optional<double> color_stamp_s;  // unset: that of the depth
  std::string color_problem;            // why `color` is empty though the recording has an image
  CameraIntrinsics intrinsics;          // of the depth camera; width and height equal those of `depth`
  std::optional<CameraIntrinsics>
      color_intrinsics;       // unset: colour has the depth camera's, depth is registered to it
  std::optional<Pose> T_C_D;  // unset: depth is registered to colour
  LensDistortion distortion, color_distortion;  // of the images; FrameRegistration takes it out
  std::optional<Pose> T_W_D;  // reference pose, where the recording has one for this very frame
  MotionReadings readings;    // of other sensors, since the frame before
  bool y_mirrored = false;    // y was up (see y_down.h): reference poses from elsewhere must be mirrored, too
};

// The camera of the frame's colour image.
inline CameraIntrinsics colorCamera(const RgbdFrame& frame) {
  return frame.color_intrinsics.value_or(frame.intrinsics);
}

// Why the frame's colour cannot be used; empty if it can.
inline std::string colorProblem(const RgbdFrame& frame) {
  if (!frame.color_problem.empty()) return frame.color_problem;
  if (frame.color.empty()) return "no colour image";
  const CameraIntrinsics camera = colorCamera(frame);
  if (frame.color.cols == camera.width && frame.color.rows == camera.height) return {};
  return "the colour image is " + sizeText(frame.color.cols, frame.color.rows) + ", its intrinsics are for " +
         sizeText(camera.width, camera.height) +
         "; give the colour camera's own intrinsics, or colour of that size";
}

// What colorProblem() says; empty, too, where the recording has no colour for the frame.
inline std::string presentColorProblem(const RgbdFrame& frame) {
  return frame.color.empty() && frame.color_problem.empty() ? "" : colorProblem(frame);
}

}  // namespace depth_fusion
