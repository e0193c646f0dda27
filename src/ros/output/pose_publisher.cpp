#include "ros/output/pose_publisher.h"

#include <boost/make_shared.hpp>
#include <cstdint>

#include "depth_fusion/common/error.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kQueue = 10;
constexpr double kPathStep_m = 0.02;
constexpr double kPathStep_rad = 0.05;
constexpr size_t kMaxPath = 5000;

// The optical frame (z forward, y down) of a camera that looks along x with z up.
Pose levelCamera() {
  Pose T_map_camera = Pose::Identity();
  T_map_camera.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return T_map_camera;
}

}  // namespace

PosePublisher::PosePublisher(ros::NodeHandle handle, ros::NodeHandle private_handle,
                             const PoseParameters& parameters)
    : parameters_(parameters), tree_(handle, parameters.map_frame) {
  pose_publisher_ = private_handle.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", kQueue);
  path_publisher_ = private_handle.advertise<nav_msgs::Path>(
      "path", 1, [this](const ros::SingleSubscriberPublisher& viewer) {
        const std::lock_guard<std::mutex> lock(path_mutex_);
        if (!path_.poses.empty()) viewer.publish(path_);
      });
}

Pose PosePublisher::startPose(const std_msgs::Header& camera) {
  findRoot(camera.frame_id);
  if (root_.frame != camera.frame_id) return tree_.cameraIn(root_.frame, camera);
  return parameters_.level_start ? levelCamera() : Pose::Identity();
}

void PosePublisher::findRoot(const std::string& camera_frame) {
  if (!root_.frame.empty()) return followRoot(camera_frame);
  const std::string given = parameters_.odom_frame.empty() ? parameters_.base_frame : parameters_.odom_frame;
  takeRoot(given.empty() ? tree_.settledRootOf(camera_frame) : CameraTree::Root{given});
}

void PosePublisher::followRoot(const std::string& camera_frame) {
  if (!parameters_.odom_frame.empty() || !parameters_.base_frame.empty()) return;
  const CameraTree::Root root = tree_.rootOf(camera_frame);
  if (root == root_) return;
  ROS_WARN(
      "the camera's tree on tf has changed: %s at the top, no longer %s; the map stays as it began. Who "
      "listened "
      "before may know %s -> %s still; give odom_frame or base_frame to be sure from the start",
      root.frame.c_str(), root_.frame.c_str(), parameters_.map_frame.c_str(), root_.frame.c_str());
  takeRoot(root);
}

void PosePublisher::takeRoot(const CameraTree::Root& root) {
  root_ = root;
  T_map_root_.reset();
  if (!root.in_map) return tree_.leaveOut(root.frame);
  ROS_ERROR(
      "somebody else publishes %s -> %s on tf; the tracker's poses go out as messages only. Let it map at "
      "those "
      "poses (tracking: external), or choose another map_frame",
      parameters_.map_frame.c_str(), root.frame.c_str());
}

void PosePublisher::publish(const std_msgs::Header& camera, const Pose& T_map_camera,
                            const Matrix6d& covariance) {
  const std_msgs::Header header = makeHeader(camera.stamp, parameters_.map_frame);
  auto pose = boost::make_shared<geometry_msgs::PoseWithCovarianceStamped>();
  pose->header = header;
  pose->pose = toMessage(T_map_camera, covariance);
  pose_publisher_.publish(pose);
  addToPath(header, T_map_camera);
  try {
    publishTransform(camera, T_map_camera);
  } catch (const Error& error) {
    ROS_WARN_STREAM_THROTTLE(5.0, "icp_tracking: no transform sent: " << error.what());
  }
}

void PosePublisher::publishTransform(const std_msgs::Header& camera, const Pose& T_map_camera) {
  findRoot(camera.frame_id);
  if (!parameters_.publish_tf || root_.in_map) return;
  T_map_root_ = T_map_camera * tree_.cameraIn(root_.frame, camera).inverse();
  send(camera.stamp);
}

void PosePublisher::publishLost(const std_msgs::Header& camera) {
  if (T_map_root_ && root_.frame != camera.frame_id) send(camera.stamp);
}

void PosePublisher::send(const ros::Time& stamp) {
  broadcaster_.sendTransform(
      makeTransform(makeHeader(stamp, parameters_.map_frame), root_.frame, *T_map_root_));
}

void PosePublisher::reset() {
  T_map_root_.reset();
  const std::lock_guard<std::mutex> lock(path_mutex_);
  if (path_.poses.empty()) return;
  path_.poses.clear();
  publishPath();
}

void PosePublisher::addToPath(const std_msgs::Header& header, const Pose& T_map_camera) {
  const Pose step = T_map_last_.inverse() * T_map_camera;
  if (!path_.poses.empty() && step.translation().norm() < kPathStep_m && rotationAngle(step) < kPathStep_rad)
    return;
  T_map_last_ = T_map_camera;
  const std::lock_guard<std::mutex> lock(path_mutex_);
  path_.header = header;
  path_.poses.emplace_back();
  path_.poses.back().header = header;
  path_.poses.back().pose = toMessage(T_map_camera);
  if (path_.poses.size() > kMaxPath) {
    for (size_t i = 0; i < kMaxPath / 2; ++i) path_.poses[i] = path_.poses[2 * i];
    path_.poses.erase(path_.poses.begin() + kMaxPath / 2, path_.poses.begin() + kMaxPath);
  }
  publishPath();
}

void PosePublisher::publishPath() {
  if (path_publisher_.getNumSubscribers() > 0)
    path_publisher_.publish(boost::make_shared<nav_msgs::Path>(path_));
}

}  // namespace depth_fusion
