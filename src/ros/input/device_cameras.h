// The calibration of a camera, by camera_info_manager, as openni2_camera has it.
#pragma once

#include <camera_info_manager/camera_info_manager.h>

#include <string>

namespace depth_fusion {

class DeviceCameras {
 public:
  // Serves rgb/set_camera_info and depth/set_camera_info. Empty URLs:
  // ~/.ros/camera_info/{rgb,depth}_SERIAL.yaml.
  DeviceCameras(const ros::NodeHandle& handle, const std::string& rgb_url, const std::string& depth_url);

  // The calibrations are this device's.
  void setDevice(const std::string& serial);

  // The calibration if it is for images of this size, else square pixels with this horizontal field of view.
  sensor_msgs::CameraInfo colorInfo(int width, int height, double field_of_view_rad);
  sensor_msgs::CameraInfo depthInfo(int width, int height, double field_of_view_rad);

 private:
  camera_info_manager::CameraInfoManager color_, depth_;
};

}  // namespace depth_fusion
