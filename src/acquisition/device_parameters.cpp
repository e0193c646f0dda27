#include "depth_fusion/acquisition/rgbd_device.h"

namespace depth_fusion {
namespace {

constexpr double kMaxSetting = 1e6;

}  // namespace

ParameterTable CameraSettings::table() {
  return {
      {"auto_exposure", &auto_exposure, 0, 1, "of the colour camera"},
      {"auto_white_balance", &auto_white_balance, 0, 1, "of the colour camera"},
      {"exposure", &exposure, 0, kMaxSetting, "in the driver's units, without auto_exposure; 0: as it is"},
      {"gain", &gain, 0, kMaxSetting, "in the driver's units, without auto_exposure; 0: as it is"}};
}

ParameterTable DeviceParameters::table() {
  ParameterTable rows = atStartOnly(
      {{"device_id", &device_id, 0, 0,
        "a camera: #1 (the first), URI, serial number or USB bus@address; or an .oni file"},
       {"depth_mode", &depth_mode, 0, 0, "WIDTHxHEIGHT@FPS of the camera"},
       {"color_mode", &color_mode, 0, 0, "the same, or off"},
       {"ir_mode", &ir_mode, 0, 0, "the same, or off; many cameras have either colour or infrared"},
       {"depth_registration", &depth_registration, 0, 1,
        "depth as the colour camera sees it, if the camera can"},
       {"color_depth_synchronization", &color_depth_synchronization, 0, 1,
        "both at the same moment, if the camera can"}});
  const ParameterTable camera_rows = camera.table();
  rows.insert(rows.end(), camera_rows.begin(), camera_rows.end());
  return rows;
}

}  // namespace depth_fusion
