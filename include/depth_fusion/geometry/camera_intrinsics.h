// Pinhole camera without distortion.
#pragma once

#include <string>

namespace depth_fusion {

// Focal lengths and principal point in pixels; the centre of the top left pixel is (0, 0).
// A point (x, y, z) of the optical frame (x right, y down, z forward) falls on (fx x/z + cx, fy y/z + cy).
struct CameraIntrinsics {
  int width = 0;
  int height = 0;
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;

  bool valid() const { return width > 0 && height > 0 && fx > 0.0 && fy > 0.0; }
};

inline bool sameCamera(const CameraIntrinsics& a, const CameraIntrinsics& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy && a.cx == b.cx &&
         a.cy == b.cy;
}

inline std::string sizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

// The intrinsics of the image in which each pixel covers 2x2 pixels of the given one.
inline CameraIntrinsics halved(const CameraIntrinsics& camera) {
  CameraIntrinsics half;
  half.width = camera.width / 2;
  half.height = camera.height / 2;
  half.fx = camera.fx / 2.0;
  half.fy = camera.fy / 2.0;
  half.cx = (camera.cx + 0.5) / 2.0 - 0.5;
  half.cy = (camera.cy + 0.5) / 2.0 - 0.5;
  return half;
}

}  // namespace depth_fusion
