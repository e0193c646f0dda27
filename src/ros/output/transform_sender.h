// The one sender of map_frame -> the root of the camera's tree on tf (REP 105).
#pragma once

#include <ros/node_handle.h>
#include <tf2_ros/transform_broadcaster.h>

#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "depth_fusion/frames/motion_readings.h"
#include "ros/callbacks/callback_gate.h"
#include "ros/output/camera_tree.h"
#include "ros/output/pose_parameters.h"

namespace depth_fusion {

// The root is odom_frame or base_frame where one is given, else whatever stands at the top (odom on a robot
// that has it, camera_link under a driver, or the camera itself), so that no frame gets a second parent. If
// the tree grows later, its new root takes the place of the old one.
//
// A root in which the camera never moves goes out with every pose, at the image's stamp. One in which it
// does, as in odometry, goes out at a steady rate, stamped ahead, by the newest pose whose odometry has come,
// and goes on while there are no poses. No pose waits for odometry. Where the images have another clock than
// odometry, each pose is taken with the odometry that is there when it comes. Thread-safe.
class TransformSender {
 public:
  TransformSender(ros::NodeHandle handle, const PoseParameters& parameters);

  // Returns T_map_camera for the first frame, with which the root stands at the map's origin. A camera
  // without a tree, or one that tf does not connect with the given root, looks along x with z up (REP 103),
  // or is the origin itself without level_start. Where gravity is known, `up_camera` is the direction against
  // it, and such a camera begins as it is held. The first call waits until the tree no longer grows.
  Pose startPose(const std_msgs::Header& camera, const std::optional<Eigen::Vector3d>& up_camera);
  // Returns T_base_camera, of the robot's base: base_frame, or base_link or base_footprint where tf has one.
  std::optional<Pose> cameraOnBase(const std::string& camera_frame) const;
  // Returns where odometry has the camera at the image's stamp, or by the newest that there is; none without
  // odometry, or where the two have different clocks.
  std::optional<OdometryReading> odometry(const std_msgs::Header& camera) const;
  // Returns T_frame_camera as tf last had it.
  std::optional<Pose> cameraIn(const std::string& frame, const std::string& camera_frame) const;
  // What the camera is mounted on: the base if there is one, else the root of its tree if it does not move in
  // that, else the camera itself.
  struct Body {
    std::string frame;
    Pose T_body_camera;
  };
  Body bodyOf(const std::string& camera_frame) const;
  void take(const std_msgs::Header& camera, const Pose& T_map_camera);
  // Sends map_frame -> a frame that nothing else hangs on.
  void sendLeaf(const ros::Time& stamp, const std::string& frame, const Pose& T_map_frame);
  // Forgets the poses, which belong to another map.
  void reset();

  // What is wrong with the odometry or the tree, and what to do; empty if nothing is.
  std::string problem() const;

 private:
  struct Tracked {
    std_msgs::Header camera;
    Pose T_map_camera;
  };

  std::optional<Body> baseOf(const std::string& camera_frame) const;
  bool hasRoot() const;
  // These expect the mutex to be held:
  void followRoot(const std::string& camera_frame);
  void takeRoot(const CameraTree::Root& root);
  // Whether the camera has been seen to move in the root, or is bound to.
  bool movesInRoot(const Pose& T_root_camera);
  // Whether the images' stamps are not of ROS time, while odometry's are, or were as long as it lived.
  bool isOtherClock(const ros::Time& odometry) const;
  void useNewestOdometry();
  void send(const ros::Time& stamp, const std::string& child, const Pose& T_map_child);
  // What time it is by the clock that odometry has, too.
  ros::Time robotTime() const;
  // How old the last image was when its pose came.
  double lag_s() const;

  void sendAhead();

  const PoseParameters parameters_;
  CameraTree tree_;
  tf2_ros::TransformBroadcaster broadcaster_;

  mutable std::mutex mutex_;      // of all that follow
  CameraTree::Root root_;         // empty until the first frame
  std::optional<Pose> mounting_;  // T_root_camera as it was first seen
  bool moves_ = false;            // the camera, in the root
  std::optional<Tracked> last_;
  ros::Time last_taken_;  // the ROS time at which it was
  bool has_other_clock_ = false;
  std::deque<Tracked> waiting_;  // for their odometry, oldest first
  std::optional<CameraTree::Placed> odometry_;
  ros::WallTime odometry_came_;
  std::optional<Pose> T_map_root_;  // of the steady rate
  ros::Time last_sent_;

  CallbackGate callbacks_;  // last: the timer uses the others
  ros::WallTimer timer_;
};

}  // namespace depth_fusion
