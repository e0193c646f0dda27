// The tracker's poses for the rest of the robot: tf2 (REP 105), PoseWithCovarianceStamped, Path.
#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Path.h>
#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>

#include <mutex>
#include <optional>
#include <string>

#include "ros/output/camera_tree.h"
#include "ros/output/pose_parameters.h"

namespace depth_fusion {

// On tf it is map_frame -> the root of the camera's tree: odom_frame or base_frame where one is given, else
// whatever stands at the top (odom on a robot that has it, camera_link under a driver, or the camera itself),
// so that no frame gets a second parent. Where somebody publishes on tf, the first frame waits until that
// tree no longer grows. If it grows later all the same, its new root takes the place of the old one.
class PosePublisher {
 public:
  PosePublisher(ros::NodeHandle handle, ros::NodeHandle private_handle, const PoseParameters& parameters);

  // Returns T_map_camera for the first frame, with which the root stands at the map's origin. A camera
  // without a tree looks along x with z up (REP 103), or is the origin itself without level_start.
  Pose startPose(const std_msgs::Header& camera);
  // Publishes the pose; no transform is sent, and the log says so, if odom_frame or base_frame is not
  // connected to the camera.
  void publish(const std_msgs::Header& camera, const Pose& T_map_camera, const Matrix6d& covariance);
  // Says that the pose is not known; the robot's odometry carries on from the last one.
  void publishLost(const std_msgs::Header& camera);
  // Forgets the path and the last pose, which belong to another map.
  void reset();

 private:
  void findRoot(const std::string& camera_frame);
  void followRoot(const std::string& camera_frame);
  void takeRoot(const CameraTree::Root& root);
  // Throws Error if the root is not connected to the camera.
  void publishTransform(const std_msgs::Header& camera, const Pose& T_map_camera);
  void send(const ros::Time& stamp);
  void addToPath(const std_msgs::Header& header, const Pose& T_map_camera);
  void publishPath();

  PoseParameters parameters_;
  CameraTree tree_;
  tf2_ros::TransformBroadcaster broadcaster_;
  CameraTree::Root root_;  // empty until the first frame
  std::optional<Pose> T_map_root_;
  std::mutex path_mutex_;  // of the path, which late viewers get whole
  nav_msgs::Path path_;
  Pose T_map_last_ = Pose::Identity();              // of the path
  ros::Publisher pose_publisher_, path_publisher_;  // last: the path's viewers are served from the others
};

}  // namespace depth_fusion
