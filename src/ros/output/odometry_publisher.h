// The tracker's motion for who fuses it with other odometry (robot_localization): nav_msgs/Odometry, and the
// pose of the robot's body in the map.
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "depth_fusion/loops/corrections.h"
#include "depth_fusion/pipeline/map_odometry.h"
#include "ros/output/transform_sender.h"

namespace depth_fusion {

class OdometryPublisher {
 public:
  OdometryPublisher(ros::NodeHandle private_handle, const PoseParameters& parameters,
                    TransformSender& transforms);

  void publish(const std_msgs::Header& camera, const TrackingResult& tracked);
  // The next pose is in another map.
  void reset() { odometry_.leaveWorld(); }
  // Closed loops have moved the map.
  void correct(const Corrections& corrections);

 private:
  void publishMotion(const std_msgs::Header& body, const OdometryState& state);

  const std::string map_frame_, visual_odom_frame_;
  TransformSender& transforms_;
  MapOdometry odometry_;
  ros::Publisher odometry_publisher_, base_pose_publisher_;
};

}  // namespace depth_fusion
