// Where a feature's patch lies in another image, to a fraction of a pixel.
#pragma once

#include "depth_fusion/frames/frame_features.h"

namespace depth_fusion {

// Aligns the patch from `start` by inverse compositional Lucas-Kanade over translations, which is blind to
// brightness offsets. Returns nothing if it diverges or the patch looks different there.
std::optional<Eigen::Vector2d> alignPatch(const FeaturePatch& patch, const cv::Mat& smoothed,
                                          const Eigen::Vector2d& start);

}  // namespace depth_fusion
