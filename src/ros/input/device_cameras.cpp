#include "ros/input/device_cameras.h"

#include <algorithm>
#include <cctype>

#include "acquisition/field_of_view.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

sensor_msgs::CameraInfo infoOf(camera_info_manager::CameraInfoManager& manager, int width, int height,
                               double angle_rad) {
  if (manager.isCalibrated()) {
    const sensor_msgs::CameraInfo info = manager.getCameraInfo();
    if (static_cast<int>(info.width) == width && static_cast<int>(info.height) == height) return info;
    ROS_WARN_STREAM_ONCE("the calibration of the camera is for "
                         << info.width << "x" << info.height << ", the images are " << width << "x" << height
                         << "; it is not used");
  }
  return makeCameraInfo({}, cameraFromFieldOfView(width, height, angle_rad));
}

}  // namespace

DeviceCameras::DeviceCameras(const ros::NodeHandle& handle, const std::string& rgb_url,
                             const std::string& depth_url)
    : color_(ros::NodeHandle(handle, "rgb"), "rgb", rgb_url),
      depth_(ros::NodeHandle(handle, "depth"), "depth", depth_url) {}

void DeviceCameras::setDevice(const std::string& serial) {
  std::string name = serial;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  color_.setCameraName("rgb_" + name);
  depth_.setCameraName("depth_" + name);
}

sensor_msgs::CameraInfo DeviceCameras::colorInfo(int width, int height, double field_of_view_rad) {
  return infoOf(color_, width, height, field_of_view_rad);
}

sensor_msgs::CameraInfo DeviceCameras::depthInfo(int width, int height, double field_of_view_rad) {
  return infoOf(depth_, width, height, field_of_view_rad);
}

}  // namespace depth_fusion
