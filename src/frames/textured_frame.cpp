#include "depth_fusion/frames/textured_frame.h"

namespace depth_fusion {

std::vector<FrameMotion> TexturedFrame::measuredMotions() const {
  std::vector<FrameMotion> motions;
  if (motion.found) motions.push_back(motion);
  motions.insert(motions.end(), robot.motions.begin(), robot.motions.end());
  return motions;
}

TexturedFrame withoutTexture(const std::string& reason) {
  TexturedFrame frame;
  frame.motion.reason = frame.features.reason = reason;
  return frame;
}

}  // namespace depth_fusion
