// What a real colour camera makes of an ideal view.
#pragma once

#include <cstdint>

#include "tools/simulation/renderer.h"

namespace depth_fusion {

// As it is, it leaves the image alone.
struct ColorModel {
  double exposure_s = 0.0;    // motion blurs what is exposed so long
  double target_level = 0.0;  // automatic exposure brings the mean to it, by a factor of 4 at most; 0: none
  double read_sigma = 0.0;    // noise in the dark, of 255 levels
  double shot_gain = 0.0;     // the noise's variance grows by it a level
};

// Models an indoor video camera: 1/60 s, noise of 2 levels in the dark and 4 in the light.
ColorModel videoCamera();

// How the camera moves meanwhile: points seen at the stamp, in the camera's frames of begin and end.
struct ExposureMotion {
  Pose T_begin_D = Pose::Identity();
  Pose T_end_D = Pose::Identity();
};

// Returns the image as the camera gives it. The same seed gives the same image, bit for bit.
cv::Mat senseColor(const RenderedView& view, const ColorModel& model, const CameraIntrinsics& camera,
                   const ExposureMotion& motion, uint64_t seed);

}  // namespace depth_fusion
