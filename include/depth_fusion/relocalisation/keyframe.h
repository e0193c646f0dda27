// A frame of the past that a new one can be matched to.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "depth_fusion/frames/frame_features.h"

namespace depth_fusion {

// A thumbnail is small enough to be blind to a shift by a tenth of the image.
constexpr int kThumbnailWidth_px = 32;
constexpr int kThumbnailHeight_px = 24;

// It takes some 200 kB.
struct Keyframe {
  FrameFeatures features;  // without the smoothed images
  cv::Mat thumbnail;       // CV_32FC1, zero mean, unit norm
  Pose T_W_D = Pose::Identity();
};

// A keyframe does not change, so that all who need it share it.
using KeyframePtr = std::shared_ptr<const Keyframe>;
using Keyframes = std::vector<KeyframePtr>;

}  // namespace depth_fusion
