// What a camera is told.
#pragma once

#include <string>

#include "depth_fusion/common/parameters.h"

namespace depth_fusion {

struct CameraSettings {
  bool auto_exposure = true;
  bool auto_white_balance = true;
  int exposure = 0;  // in the driver's units; 0: as it is
  int gain = 0;

  ParameterTable table();
};

// The names are openni2_camera's.
struct DeviceParameters {
  std::string device_id;
  std::string depth_mode = "640x480@30", color_mode = "640x480@30", ir_mode = "off";
  bool depth_registration = true;
  bool color_depth_synchronization = false;
  CameraSettings camera;

  ParameterTable table();
};

}  // namespace depth_fusion
