// How well a picture was predicted.
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>

#include "depth_fusion/texturing/texturing.h"

namespace depth_fusion {

struct PictureError {
  double psnr_db = 0.0;
  size_t pixels = 0;  // that were compared
};

// Compares where `covered` (CV_8UC1) is not 0, but for its outermost pixels. Exposure and white balance are
// no errors: the prediction's channels are scaled to fit. Both pictures are CV_8UC3 of one size.
PictureError comparePictures(const cv::Mat& predicted, const cv::Mat& picture, const cv::Mat& covered);

// Where the view's picture was taken, by the colours of the textured mesh: its pose is a start. Poses that
// are off by some pixels say nothing about a texture.
Pose fittedPose(const TexturedMesh& mesh, const TexturingView& view);

}  // namespace depth_fusion
