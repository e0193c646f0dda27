// What a driver's camera_info topics and tf say about the two cameras of an RGB-D sensor.
#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <tf2_ros/transform_listener.h>

#include <deque>
#include <memory>
#include <mutex>
#include <string>

#include "ros/in_process/frames.h"
#include "ros/input/rgbd_pairing.h"

namespace depth_fusion {

// Thread-safe.
class SensorCameras {
 public:
  // Subscribes depth/camera_info and rgb/camera_info of the handle's namespace, and tf where it is needed.
  explicit SensorCameras(ros::NodeHandle handle);
  // Waits for the callbacks in progress.
  ~SensorCameras();

  // The depth camera's camera_info is here, and tf connects the cameras if their frames differ.
  bool areKnown(const std_msgs::Header& depth);
  // A camera_info of the depth camera has come.
  bool hasDepth() const;
  const std::string& depthInfoTopic() const { return depth_info_topic_; }
  // The depth camera without its lens's distortion, for points that have none. Throws Error where no
  // camera_info has come.
  CameraIntrinsics depthCamera(const ros::Time& stamp) const;
  // Sets the frame's intrinsics, its lens distortions and T_C_D by the camera_info of the images' stamps, or
  // the latest where there is none. The names of the image topics tell whether the images are rectified.
  // Returns the tf frame of the colour camera where T_C_D is set, else an empty name. What is wrong with the
  // colour camera is the frame's color_problem. Throws Error that says what is missing or does not fit of
  // depth.
  std::string describe(const RgbdMessages& messages, SensorFrame& frame);

 private:
  using Infos = std::deque<sensor_msgs::CameraInfoConstPtr>;  // the latest, in the order that they came in

  ros::Subscriber subscribe(const std::string& name, Infos& infos);
  // Null before the first.
  sensor_msgs::CameraInfoConstPtr find(const Infos& infos, const ros::Time& stamp) const;
  void describeDepth(const sensor_msgs::CameraInfo* info, const std::string& topic, RgbdFrame& frame) const;
  std::string describeColor(const sensor_msgs::CameraInfo& info, const std::string& topic,
                            SensorFrame& frame);
  Pose lookUp(const std::string& color_frame, const std::string& depth_frame);
  tf2_ros::Buffer& tf();

  ros::NodeHandle handle_;
  const std::string depth_info_topic_, color_info_topic_;
  mutable std::mutex mutex_;  // guards the next four
  Infos depth_infos_, color_infos_;
  std::unique_ptr<tf2_ros::Buffer> tf_;  // null, as is the next, before it is first needed
  std::unique_ptr<tf2_ros::TransformListener> tf_listener_;
  ros::Subscriber depth_subscriber_, color_subscriber_;
};

}  // namespace depth_fusion
