#include "ros/input/device_publisher_parameters.h"

namespace depth_fusion {

ParameterTable DeviceTimeParameters::table() {
  return {flag("use_device_time", &use_device_time,
               "stamps by the camera's clock, set by the host's; false: the time of arrival"),
          number("depth_time_offset", &depth_time_offset, -1.0, 1.0,
                 "seconds added to the stamps of a camera's depth"),
          number("color_time_offset", &color_time_offset, -1.0, 1.0,
                 "seconds added to the stamps of a camera's colour"),
          number("ir_time_offset", &ir_time_offset, -1.0, 1.0,
                 "seconds added to the stamps of a camera's infrared")};
}

ParameterTable DevicePublisherParameters::table() {
  ParameterTable rows = device.table();
  for (const ParameterTable& more :
       {atStartOnly({text("rgb_frame_id", &rgb_frame_id,
                          "optical frame of a camera's colour, and of depth registered to it"),
                     text("depth_frame_id", &depth_frame_id,
                          "optical frame of a camera's infrared, and of other depth"),
                     text("rgb_camera_info_url", &rgb_camera_info_url,
                          "calibration; empty: ~/.ros/camera_info/rgb_SERIAL.yaml"),
                     text("depth_camera_info_url", &depth_camera_info_url, "the same: depth_SERIAL.yaml")}),
        time.table()})
    rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

}  // namespace depth_fusion
