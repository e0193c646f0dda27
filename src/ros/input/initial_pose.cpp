#include "ros/input/initial_pose.h"

#include <ros/console.h>

#include <utility>

#include "depth_fusion/common/error.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {

InitialPose::InitialPose(ros::NodeHandle handle, const std::string& map_frame,
                         std::function<void(const Pose& T_map_base)> take)
    : map_frame_(map_frame),
      take_(std::move(take)),
      subscriber_(handle.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
          "/initialpose", 1, [this](const auto& message) { receive(*message); })) {}

void InitialPose::receive(const geometry_msgs::PoseWithCovarianceStamped& message) const {
  try {
    check(message.header.frame_id == map_frame_,
          "/initialpose is in the frame '" + message.header.frame_id + "'; give it in " + map_frame_);
    take_(fromMessage(message.pose.pose));
  } catch (const Error& error) {
    ROS_ERROR("%s", error.what());
  }
}

}  // namespace depth_fusion
