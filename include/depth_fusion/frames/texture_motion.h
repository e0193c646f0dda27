// The motion of a frame's texture since the frame before.
#pragma once

#include <string>

#include "depth_fusion/frames/motion_prior.h"

namespace depth_fusion {

struct TextureOdometryResult : FrameMotion {
  TextureOdometryResult() : FrameMotion{"texture"} {}

  bool found = false;  // the motion is valid
  std::string reason;  // why no motion was found; empty otherwise
  int features = 0;    // of the current frame
  int matches = 0;
  int inliers = 0;
};

}  // namespace depth_fusion
