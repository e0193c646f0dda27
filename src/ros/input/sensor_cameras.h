// What a driver's camera_info topics and tf say about the two cameras of an RGB-D sensor.
#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <mutex>
#include <string>

#include "ros/in_process/frames.h"

namespace depth_fusion {

// Thread-safe.
class SensorCameras {
 public:
  // Subscribes depth/camera_info and rgb/camera_info of the handle's namespace, and tf where it is needed.
  // The names of the image topics tell whether the images are rectified.
  SensorCameras(ros::NodeHandle handle, const std::string& depth_topic, const std::string& color_topic);
  // Waits for the callbacks in progress.
  ~SensorCameras();

  // The depth camera's camera_info is here, and tf connects the cameras if their frames differ.
  bool areKnown(const std_msgs::Header& depth);
  // Sets the frame's intrinsics, its lens distortions and T_C_D. Returns the tf frame of the colour camera
  // where T_C_D is set, else an empty name. Throws Error that says what is missing or does not fit.
  std::string describe(SensorFrame& frame);

 private:
  struct Infos {
    sensor_msgs::CameraInfoConstPtr depth, color;  // null before the first
  };

  ros::Subscriber subscribe(ros::NodeHandle& handle, const std::string& name,
                            sensor_msgs::CameraInfoConstPtr Infos::*info);
  Infos latest() const;
  void describeDepth(const sensor_msgs::CameraInfo* info, RgbdFrame& frame) const;
  std::string describeColor(const sensor_msgs::CameraInfo* info, SensorFrame& frame);
  Pose lookUp(const std::string& color_frame, const std::string& depth_frame);
  tf2_ros::Buffer& tf();

  ros::NodeHandle handle_;
  std::string depth_topic_, color_topic_, info_topic_;
  mutable std::mutex mutex_;  // guards the next three
  Infos infos_;
  std::unique_ptr<tf2_ros::Buffer> tf_;  // null, as is the next, before it is first needed
  std::unique_ptr<tf2_ros::TransformListener> tf_listener_;
  ros::Subscriber depth_subscriber_, color_subscriber_;
};

}  // namespace depth_fusion
