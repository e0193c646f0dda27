// Images of normals, packed.
#pragma once

#include "depth_fusion/compute/device_image.h"
#include "geometry/packed_normal.h"
#include "reference/depth_preprocessing.h"

namespace depth_fusion {

// Packs the normals and unpacks them, so that they are as the device holds them.
inline cv::Mat quantisedNormals(cv::Mat normals) {
  reference::forEachPixel<cv::Vec3f>(normals,
                                     [](int, int, cv::Vec3f& n) { n = unpackedNormal(packedNormal(n)); });
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
