// The surface under a feature, from the depth image.
#pragma once

#include "depth_fusion/frames/frame_features.h"
#include "depth_fusion/frames/rgbd_frame.h"

namespace depth_fusion {

// Converts a pixel of a pyramid level to pixels of the full image.
template <class Point>
Eigen::Vector2d fullImagePixel(const Point& pixel, int level) {
  const double scale = 1 << level;
  return {scale * (pixel.x + 0.5) - 0.5, scale * (pixel.y + 0.5) - 0.5};
}

inline Eigen::Vector3d rayThrough(const CameraIntrinsics& camera, const Eigen::Vector2d& pixel) {
  return {(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy, 1.0};
}

inline Eigen::Vector2d project(const CameraIntrinsics& camera, const Eigen::Vector3d& point) {
  return {camera.fx * point.x() / point.z() + camera.cx, camera.fy * point.y() / point.z() + camera.cy};
}

// Fills in the features' surfaces.
void findSurfaces(const RgbdFrame& frame, FrameFeatures& features);

}  // namespace depth_fusion
