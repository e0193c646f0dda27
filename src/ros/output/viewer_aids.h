// What helps who looks at the map in rviz: a frame that the view can follow, and a sign that says "LOST".
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "depth_fusion/geometry/pose.h"
#include "ros/output/view_frame.h"

namespace depth_fusion {

// For one thread.
class ViewerAids {
 public:
  // Publishes `state_marker` in the handle's namespace.
  ViewerAids(ros::NodeHandle private_handle, const std::string& map_frame, const std::string& view_frame);

  // The view's frame follows the camera. A sign that was there goes.
  void showTracked(const ros::Time& stamp, const Pose& T_map_camera);
  // Shows a sign with that text where the camera was last.
  void showSign(const std::string& text);

 private:
  void publishSign(int action, const std::string& text);

  const std::string map_frame_;
  ViewFrame view_;
  ros::Publisher sign_publisher_;
  std::string sign_;  // shown now; empty: none
  Eigen::Vector3d camera_ = Eigen::Vector3d::Zero();
};

}  // namespace depth_fusion
