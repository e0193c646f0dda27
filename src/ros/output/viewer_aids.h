// What helps who looks at the map in rviz: a frame that the view can follow, and a sign that says "LOST".
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>

#include <optional>
#include <string>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// For one thread.
class ViewerAids {
 public:
  // Publishes `state_marker` in the handle's namespace. An empty view_frame is not sent.
  ViewerAids(ros::NodeHandle private_handle, const std::string& map_frame, const std::string& view_frame);

  // The view's frame stands where the camera is, level, and looks where the camera looked at first. A sign
  // that was there goes.
  void showTracked(const ros::Time& stamp, const Pose& T_map_camera);
  // Shows a sign with that text where the camera was last.
  void showSign(const std::string& text);

 private:
  void publishSign(int action, const std::string& text);

  const std::string map_frame_, view_frame_;
  ros::Publisher sign_publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::string sign_;  // shown now; empty: none
  Eigen::Vector3d camera_ = Eigen::Vector3d::Zero();
  std::optional<double> yaw_rad_;
};

}  // namespace depth_fusion
