// How the images of a camera are published.
#pragma once

#include <string>

#include "depth_fusion/acquisition/device_parameters.h"
#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

// The names are openni2_camera's.
struct DeviceTimeParameters {
  bool use_device_time = true;
  float depth_time_offset = -0.033f, color_time_offset = -0.033f, ir_time_offset = -0.033f;  // seconds

  ParameterTable table();
};

struct DevicePublisherParameters {
  DeviceParameters device;
  std::string rgb_frame_id = "camera_rgb_optical_frame", depth_frame_id = "camera_depth_optical_frame";
  std::string rgb_camera_info_url, depth_camera_info_url;
  DeviceTimeParameters time;

  ParameterTable table();
};

}  // namespace depth_fusion
