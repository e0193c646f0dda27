// Where somebody says that the robot is: rviz's "2D Pose Estimate".
#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/node_handle.h>

#include <functional>
#include <string>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

class InitialPose {
 public:
  // Subscribes /initialpose. Poses that are none, or in another frame than map_frame, are said to be so.
  InitialPose(ros::NodeHandle handle, const std::string& map_frame,
              std::function<void(const Pose& T_map_base)> take);

 private:
  void receive(const geometry_msgs::PoseWithCovarianceStamped& message) const;

  const std::string map_frame_;
  const std::function<void(const Pose& T_map_base)> take_;
  ros::Subscriber subscriber_;
};

}  // namespace depth_fusion
