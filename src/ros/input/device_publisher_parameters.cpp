#include "ros/input/device_publisher_parameters.h"

namespace depth_fusion {

ParameterTable DeviceTimeParameters::table() {
  return {
      {"use_device_time", &use_device_time, 0, 1,
       "stamps by the camera's clock, set by the host's; false: the time of arrival"},
      {"depth_time_offset", &depth_time_offset, -1.0, 1.0, "seconds added to the stamps of a camera's depth"},
      {"color_time_offset", &color_time_offset, -1.0, 1.0,
       "seconds added to the stamps of a camera's colour"},
      {"ir_time_offset", &ir_time_offset, -1.0, 1.0, "seconds added to the stamps of a camera's infrared"}};
}

ParameterTable DevicePublisherParameters::table() {
  ParameterTable rows = device.table();
  for (const ParameterTable& more :
       {atStartOnly({{"rgb_frame_id", &rgb_frame_id, 0, 0,
                      "optical frame of a camera's colour, and of depth registered to it"},
                     {"depth_frame_id", &depth_frame_id, 0, 0,
                      "optical frame of a camera's infrared, and of other depth"},
                     {"rgb_camera_info_url", &rgb_camera_info_url, 0, 0,
                      "calibration; empty: ~/.ros/camera_info/rgb_SERIAL.yaml"},
                     {"depth_camera_info_url", &depth_camera_info_url, 0, 0, "the same: depth_SERIAL.yaml"}}),
        time.table()})
    rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

}  // namespace depth_fusion
