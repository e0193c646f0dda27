// Where a feature's patch lies in another image, to a fraction of a pixel.
#pragma once

#include "depth_fusion/frames/frame_features.h"

namespace depth_fusion {

// Inverse compositional Lucas-Kanade over translations, blind to brightness offsets, from `start`. Nothing if
// it diverges or the patch looks different there.
std::optional<Eigen::Vector2d> alignPatch(const FeaturePatch& patch, const cv::Mat& smoothed,
                                          const Eigen::Vector2d& start);

}  // namespace depth_fusion
