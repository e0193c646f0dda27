// Which intrinsics the frames of a recording have.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "depth_fusion/geometry/camera_intrinsics.h"

namespace depth_fusion {

struct RecordingIntrinsics {
  CameraIntrinsics camera;
  std::string source;  // for the user, as "camera.yaml"
};

// The user's intrinsics if given, else the recording's own, for depth images of this size. Throws Error,
// which begins with the recording's name, if there are none, if they are not valid or if they are for another
// size.
RecordingIntrinsics chooseIntrinsics(const std::optional<CameraIntrinsics>& given,
                                     const std::optional<RecordingIntrinsics>& own, cv::Size depth_size,
                                     const std::string& recording);

// Throws Error naming the image if its size is not that of the intrinsics.
void checkDepthSize(const cv::Mat& depth, const CameraIntrinsics& camera, const std::string& image);

// "fx fy cx cy, source".
std::string describe(const RecordingIntrinsics& intrinsics);

}  // namespace depth_fusion
