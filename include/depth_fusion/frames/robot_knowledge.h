// What the robot knows of a frame's pose before it is tracked, beside the frame's own texture.
#pragma once

#include <vector>

#include "depth_fusion/frames/known_attitude.h"
#include "depth_fusion/frames/motion_prior.h"

namespace depth_fusion {

struct RobotKnowledge {
  std::vector<FrameMotion> motions;  // since the frame before
  KnownAttitude attitude;
};

}  // namespace depth_fusion
