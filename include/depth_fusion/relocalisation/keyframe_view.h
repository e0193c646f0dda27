// The depth that a keyframe's camera sees of the map, in few bytes: loops are verified by it without the
// keyframe's submap.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

class KeyframeView {
 public:
  // A view of nothing.
  KeyframeView() = default;
  // The depth, CV_32FC1 of the camera's size in metres, 0 = none, is halved until it is so wide at most.
  KeyframeView(const cv::Mat& depth_m, const CameraIntrinsics& camera, int max_width_px);
  // What packed() gave. Throws Error, naming `where`, for bytes that are no view of that camera.
  KeyframeView(const CameraIntrinsics& camera, std::string packed, const std::string& where);

  bool isEmpty() const { return packed_.empty(); }
  const CameraIntrinsics& camera() const { return camera_; }
  // As it was given, in steps of a quarter of a millimetre, up to 16 m.
  cv::Mat depth() const;
  const std::string& packed() const { return packed_; }

 private:
  CameraIntrinsics camera_;
  std::string packed_;
};

// The image in which each pixel covers 2x2 of the given one: the mean of those at the nearest surface.
cv::Mat halvedDepth(const cv::Mat& depth_m);

}  // namespace depth_fusion
