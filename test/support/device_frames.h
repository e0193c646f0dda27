// Depth frames on the device without preprocessing.
#pragma once

#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "support/normal_images.h"

namespace depth_fusion {

constexpr float kDepthStep_m = 2e-5f;

// Packs the measurements and unpacks them, so that they are as the device holds them.
inline cv::Mat quantised(cv::Mat measurements) {
  reference::forEachPixel<cv::Vec3f>(measurements, [](int, int, cv::Vec3f& pixel) {
    pixel = reference::unpackedMeasurement(reference::packedMeasurement(pixel, kDepthStep_m), kDepthStep_m);
  });
  return measurements;
}

// Makes a frame of one level, whose raw and filtered depth (CV_32FC1, metres) are the same. `normals` are
// CV_32FC3, `measurements` CV_32FC3 as reference::measurements() has them.
inline DepthFrame frameOfDepth(ComputeContext& compute, const CameraIntrinsics& camera, const cv::Mat& depth,
                               const cv::Mat& normals, const cv::Mat& measurements) {
  DepthFrame frame;
  frame.raw_depth = zeroImage(compute, camera);
  writeImage(frame.raw_depth, camera, depth);
  const std::vector<float> tiles = reference::maxTiles(depth);
  frame.max_tiles = DeviceBuffer(compute, tiles.size() * sizeof(float), "depth tiles");
  frame.max_tiles.write(tiles);
  frame.levels.push_back({camera, zeroImage(compute, camera), zeroImage(compute, camera)});
  writeImage(frame.levels[0].depth, camera, depth);
  writeNormals(frame.levels[0].normals, camera, normals);
  cv::Mat words(depth.size(), CV_32SC1);
  reference::forEachPixel<int>(words, [&](int x, int y, int& word) {
    word = static_cast<int>(reference::packedMeasurement(measurements.at<cv::Vec3f>(y, x), kDepthStep_m));
  });
  frame.measurements = zeroImage(compute, camera);
  writeImage(frame.measurements, camera, cv::Mat(words.size(), CV_32FC1, words.data));
  frame.depth_step_m = kDepthStep_m;
  return frame;
}

}  // namespace depth_fusion
