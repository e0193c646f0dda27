// Masks: pixels that somebody found to show what is not to be mapped, people for instance.
#pragma once

#include <opencv2/core.hpp>

#include "depth_fusion/frames/rgbd_frame.h"

namespace depth_fusion {

enum class MaskView { kDepth, kColor };  // the camera that sees what the mask is of

// Takes the depth of pixels away that the mask shows to be none of the world's: those where it is not 0.
// `mask` is CV_8UC1; it has the view of a camera of the frame, in any resolution. Where that is the colour
// camera, and depth is not registered to it, each pixel's point is looked up there, by the cameras' geometry
// without the distortion of their lenses. The frame's depth is then memory of its own. Throws Error for a
// mask of another type, or of another shape than the camera's images.
void applyMask(RgbdFrame& frame, const cv::Mat& mask, MaskView view);

}  // namespace depth_fusion
