// Images of normals, packed as kernels/shared/types.h has it: read and written plainly.
#pragma once

#include <cmath>
#include <cstring>

#include "depth_fusion/compute/device_image.h"
#include "reference/depth_preprocessing.h"

namespace depth_fusion {

inline uint32_t packedNormal(const cv::Vec3f& n) {
  if (n == cv::Vec3f()) return 0;
  const auto code = [&](float component) {
    return static_cast<uint32_t>(std::lround(component / (1.0 - n[2]) * NORMAL_STEPS + NORMAL_ZERO));
  };
  return code(n[0]) | code(n[1]) << 16;
}

inline cv::Vec3f unpackedNormal(uint32_t word) {
  if (word == 0) return {};
  const double u = ((word & 0xffff) - NORMAL_ZERO) / NORMAL_STEPS, v = ((word >> 16) - NORMAL_ZERO) / NORMAL_STEPS;
  return cv::Vec3d(2.0 * u, 2.0 * v, u * u + v * v - 1.0) / (1.0 + u * u + v * v);
}

// The normals as words hold them: packed and unpacked.
inline cv::Mat quantisedNormals(cv::Mat normals) {
  reference::forEachPixel<cv::Vec3f>(normals, [](int, int, cv::Vec3f& n) { n = unpackedNormal(packedNormal(n)); });
  return normals;
}

// CV_32FC3; 0 = none.
inline cv::Mat readNormals(const DeviceBuffer& image, const CameraIntrinsics& camera) {
  const cv::Mat words = readImage(image, camera);
  cv::Mat normals(words.size(), CV_32FC3);
  reference::forEachPixel<cv::Vec3f>(normals, [&](int x, int y, cv::Vec3f& normal) {
    uint32_t word = 0;
    std::memcpy(&word, words.ptr<float>(y, x), sizeof(word));
    normal = unpackedNormal(word);
  });
  return normals;
}

inline void writeNormals(DeviceBuffer& image, const CameraIntrinsics& camera, cv::Mat normals) {
  cv::Mat words(normals.size(), CV_32SC1);
  reference::forEachPixel<cv::Vec3f>(normals, [&](int x, int y, const cv::Vec3f& normal) {
    words.at<int>(y, x) = static_cast<int>(packedNormal(normal));
  });
  writeImage(image, camera, cv::Mat(words.size(), CV_32FC1, words.data));
}

}  // namespace depth_fusion
