// How a recording is played.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct PlayerParameters {
  std::string recording, camera_file, depth_topic, color_topic, device;
  std::string frame_id = "camera_rgb_optical_frame";
  bool lossless = false, loop = false, restamp = false, publish_clock = false;
  float rate = 1.0f, lossless_timeout_s = 60.0f, settle_s = 1.0f;

  ParameterTable table();
};

}  // namespace depth_fusion
