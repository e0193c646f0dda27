// What a frame's colour image tells tracking, and what the robot knows beside.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/frames/frame_features.h"
#include "depth_fusion/frames/robot_knowledge.h"
#include "depth_fusion/frames/texture_motion.h"

namespace depth_fusion {

struct TexturedFrame {
  FrameFeatures features;
  TextureOdometryResult motion;  // since the frame before
  RobotKnowledge robot = {};

  // What was measured of the sensor's motion since the frame before, the most trusted first; empty if nothing
  // was.
  std::vector<FrameMotion> measuredMotions() const;
};

// A frame without features and motion, and the reason why it has none.
TexturedFrame withoutTexture(const std::string& reason);

}  // namespace depth_fusion
