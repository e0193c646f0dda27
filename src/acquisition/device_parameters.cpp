#include "depth_fusion/acquisition/device_parameters.h"

namespace depth_fusion {
namespace {

constexpr double kMaxSetting = 1e6;

}  // namespace

ParameterTable CameraSettings::table() {
  return {
      flag("auto_exposure", &auto_exposure, "true: the colour camera chooses its exposure"),
      flag("auto_white_balance", &auto_white_balance, "true: the colour camera chooses its white balance"),
      number("exposure", &exposure, 0, kMaxSetting,
             "the colour camera's, in the driver's units, without auto_exposure; 0: as it is"),
      number("gain", &gain, 0, kMaxSetting,
             "the colour camera's, in the driver's units, without auto_exposure; 0: as it is")};
}

ParameterTable DeviceParameters::table() {
  return joined(
      {atStartOnly({text("device_id", &device_id,
                         "a camera: #1 (the first), URI, serial number or USB bus@address; or an .oni file"),
                    text("depth_mode", &depth_mode, "size and rate of the camera's depth: WIDTHxHEIGHT@FPS"),
                    text("color_mode", &color_mode, "size and rate of the camera's colour, or off"),
                    text("ir_mode", &ir_mode,
                         "size and rate of the camera's infrared, or off; many cameras have either colour or "
                         "infrared"),
                    flag("depth_registration", &depth_registration,
                         "true: depth as the colour camera sees it, if the camera can"),
                    flag("color_depth_synchronization", &color_depth_synchronization,
                         "true: colour and depth at the same moment, if the camera can")}),
       camera.table()});
}

}  // namespace depth_fusion
