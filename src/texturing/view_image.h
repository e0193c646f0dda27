// The pictures of the surface, with what is known of their exposure.
#pragma once

#include <opencv2/core.hpp>

#include "depth_fusion/texturing/texturing.h"

namespace depth_fusion {

// A view that the texture is made of.
struct ChosenView {
  TexturingView view;
  Eigen::Array3d gain = Eigen::Array3d::Ones();  // from the image's blue, green and red to the texture's
};

// Decodes the image, CV_8UC3. Throws Error for one that is damaged, or not of its camera's size.
cv::Mat imageOf(const TexturingView& view);

// A point's pixel and depth; a depth of 0 or less is behind the camera.
Eigen::Vector3f projected(const Eigen::Vector3f& p_C, const CameraIntrinsics& camera);

// The pixel between four others; it lies in the image.
Eigen::Array3f sampled(const cv::Mat& image, float u, float v);

// Whether sampled() may be asked for the pixel, with a margin.
bool isInside(const Eigen::Vector3f& uvz, const CameraIntrinsics& camera, float margin_px);

}  // namespace depth_fusion
