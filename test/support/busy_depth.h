// Depth images for the preprocessing.
#pragma once

#include <algorithm>

#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/frames/rgbd_frame.h"
#include "geometry/kernel_args.h"
#include "reference/depth_preprocessing.h"

namespace depth_fusion {

inline CameraIntrinsics cameraOfSize(int width, int height) {
  return {width, height, 0.8 * width, 0.82 * width, 0.5 * width - 0.7, 0.5 * height + 0.3};
}

inline RgbdFrame frameOf(const cv::Mat& depth, double unit_m = 1.0) {
  RgbdFrame frame;
  frame.depth = depth;
  frame.depth_unit_m = unit_m;
  return frame;
}

// Makes noisy surfaces at two depths, with holes and out-of-range pixels.
inline cv::Mat busyDepth(const CameraIntrinsics& camera) {
  cv::Mat depth(camera.height, camera.width, CV_32FC1);
  cv::RNG random(3);
  reference::forEachPixel<float>(depth, [&](int x, int y, float& pixel) {
    const bool near = (x / 23 + y / 17) % 3 == 0;
    pixel = static_cast<float>((near ? 1.1 : 1.6) + 0.002 * x + 0.001 * y + random.gaussian(0.003));
    if (random.uniform(0, 25) == 0) pixel = random.uniform(0, 2) == 0 ? 0.0f : 7.0f;
  });
  return depth;
}

// Counts the elements of the image's buffer beside its pixels that are not 0.
inline long nonzeroPadding(const DeviceBuffer& image, const CameraIntrinsics& camera) {
  const std::vector<uint32_t> elements = image.read<uint32_t>(imageElements(camera));
  const long nonzero = elements.size() - std::count(elements.begin(), elements.end(), 0u);
  return nonzero - cv::countNonZero(readImage(image, camera));
}

}  // namespace depth_fusion
