// How a recording is played.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"
#include "depth_fusion/recording/recording.h"

namespace depth_fusion {

struct PlayerParameters {
  std::string recording, camera_file, device, frame_id = "camera_rgb_optical_frame";
  RecordingOptions options;
  bool lossless = false, loop = false, restamp = false, publish_clock = false;
  float rate = 1.0f, lossless_timeout_s = 60.0f, settle_s = 1.0f;

  ParameterTable table();
};

}  // namespace depth_fusion
