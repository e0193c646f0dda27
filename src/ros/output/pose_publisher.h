// The tracker's poses for the rest of the robot: tf2 (REP 105), PoseWithCovarianceStamped, Odometry, Path.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Path.h>
#include <ros/node_handle.h>

#include <mutex>
#include <optional>
#include <string>

#include "depth_fusion/frames/motion_prior.h"
#include "depth_fusion/loops/corrections.h"
#include "ros/output/odometry_publisher.h"
#include "ros/output/pose_parameters.h"
#include "ros/output/transform_sender.h"
#include "ros/output/viewer_aids.h"

namespace depth_fusion {

// Nothing but startPose() waits.
class PosePublisher {
 public:
  PosePublisher(ros::NodeHandle handle, ros::NodeHandle private_handle, const PoseParameters& parameters);

  // As TransformSender has it.
  Pose startPose(const std_msgs::Header& camera, const std::optional<Eigen::Vector3d>& up_camera) {
    return transforms_.startPose(camera, up_camera);
  }
  const TransformSender& transforms() const { return transforms_; }
  void publish(const std_msgs::Header& camera, const TrackingResult& tracked);
  // Shows that text where the camera was last, until the next pose. Where something else measures its motion,
  // that pose goes out as a message only: odometry on tf moves on by itself.
  void publishLost(const std_msgs::Header& camera, const std::optional<MotionPrior>& bridged,
                   const std::string& text);
  // Forgets the path and the last pose, which belong to another map.
  void reset();
  // Closed loops have moved the poses: the path goes out again as they have it.
  void correct(const Corrections& corrections);
  // Warns of what is wrong with the robot's odometry or tree on tf. From any thread.
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  void publishMessage(const std_msgs::Header& camera, const Pose& T_map_camera, const Matrix6d& covariance);
  // A path that has grown is sent, at a rate that keeps its bytes a second bounded.
  void addToPath(const std_msgs::Header& header, const Pose& T_map_camera);
  void publishPath();

  const std::string map_frame_;
  TransformSender transforms_;
  OdometryPublisher odometry_;
  ViewerAids viewer_aids_;
  std::mutex path_mutex_;  // of the path, which late viewers get whole
  nav_msgs::Path path_;
  ros::WallTime last_path_;                         // when it was sent
  Pose T_map_last_ = Pose::Identity();              // of the path
  ros::Publisher pose_publisher_, path_publisher_;  // last: the path's viewers are served from the others
};

}  // namespace depth_fusion
