// Depth frames on the device without preprocessing.
#pragma once

#include "depth_fusion/compute/device_image.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "reference/depth_preprocessing.h"

namespace depth_fusion {

// A frame of one level without normals, its depth (CV_32FC1, metres) raw and filtered alike.
inline DepthFrame frameOfDepth(ComputeContext& compute, const CameraIntrinsics& camera,
                               const cv::Mat& depth) {
  DepthFrame frame;
  frame.raw_depth = zeroImage(compute, camera, 1);
  writeImage(frame.raw_depth, camera, depth);
  const std::vector<float> tiles = reference::maxTiles(depth);
  frame.max_tiles = DeviceBuffer(compute, tiles.size() * sizeof(float), "depth tiles");
  frame.max_tiles.write(tiles);
  frame.levels.push_back({camera, zeroImage(compute, camera, 1), DeviceBuffer()});
  writeImage(frame.levels[0].depth, camera, depth);
  return frame;
}

}  // namespace depth_fusion
