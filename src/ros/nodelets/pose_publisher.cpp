#include "ros/nodelets/pose_publisher.h"

#include <boost/make_shared.hpp>

#include "depth_fusion/common/error.h"
#include "ros/messages.h"

namespace depth_fusion {
namespace {

constexpr double kTransformTimeout_s = 0.1;
constexpr double kTransformPoll_s = 0.002;
constexpr double kPathStep_m = 0.02;
constexpr double kPathStep_rad = 0.05;
constexpr size_t kMaxPath = 5000;

// From the optical frame (z forward, y down) to x forward, z up.
Pose levelCamera() {
  Pose T_map_camera = Pose::Identity();
  T_map_camera.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return T_map_camera;
}

}  // namespace

ParameterTable PoseParameters::table() {
  return atStartOnly(
      {{"publish_tf", &publish_tf, 0, 1, "false: poses as messages only"},
       {"map_frame", &map_frame, 0, 0, "frame of the map and of the poses"},
       {"odom_frame", &odom_frame, 0, 0,
        "child of map_frame on tf, where the robot has odometry; empty: base_frame, or the root of the "
        "camera's tree"},
       {"base_frame", &base_frame, 0, 0, "child of map_frame on tf, where the robot has no odometry"},
       {"level_start", &level_start, 0, 1,
        "a camera without a tf tree starts looking along x with z up; false: the map is the first optical "
        "frame"}});
}

PosePublisher::PosePublisher(ros::NodeHandle handle, ros::NodeHandle private_handle,
                             const PoseParameters& parameters)
    : parameters_(parameters), listener_(buffer_, handle) {
  pose_publisher_ = private_handle.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", 10);
  path_publisher_ = private_handle.advertise<nav_msgs::Path>("path", 1);
}

Pose PosePublisher::startPose(const std_msgs::Header& camera) {
  if (root_.empty()) findRoot(camera.frame_id);
  if (root_ != camera.frame_id) return rootToCamera(camera);
  return parameters_.level_start ? levelCamera() : Pose::Identity();
}

void PosePublisher::findRoot(const std::string& camera_frame) {
  sends_ = parameters_.publish_tf;
  root_ = parameters_.odom_frame.empty() ? parameters_.base_frame : parameters_.odom_frame;
  if (!root_.empty()) return;
  root_ = camera_frame;
  for (std::string parent; buffer_._getParent(root_, ros::Time(0), parent); root_ = parent) {
    if (parent != parameters_.map_frame) continue;
    ROS_ERROR("somebody else publishes %s -> %s on tf; the tracker's poses go out as messages only. Let it map at those poses "
              "(tracking: external), or choose another map_frame",
              parent.c_str(), root_.c_str());
    sends_ = false;
    return;
  }
}

Pose PosePublisher::rootToCamera(const std_msgs::Header& camera) const {
  if (root_ == camera.frame_id) return Pose::Identity();
  // By the wall's clock: a simulated one may stand still.
  const ros::WallTime give_up = ros::WallTime::now() + ros::WallDuration(kTransformTimeout_s);
  while (!buffer_.canTransform(root_, camera.frame_id, camera.stamp) && ros::WallTime::now() < give_up)
    ros::WallDuration(kTransformPoll_s).sleep();
  try {
    return fromMessage(buffer_.lookupTransform(root_, camera.frame_id, camera.stamp).transform);
  } catch (const tf2::TransformException& error) {
    throw Error(std::string("tf: ") + error.what());
  }
}

void PosePublisher::publish(const std_msgs::Header& camera, const Pose& T_map_camera, const Matrix6d& covariance) {
  const std_msgs::Header header = makeHeader(camera.stamp, parameters_.map_frame);
  auto pose = boost::make_shared<geometry_msgs::PoseWithCovarianceStamped>();
  pose->header = header;
  pose->pose = toMessage(T_map_camera, covariance);
  pose_publisher_.publish(pose);
  addToPath(header, T_map_camera);
  if (root_.empty()) findRoot(camera.frame_id);
  if (!sends_) return;
  T_map_root_ = T_map_camera * rootToCamera(camera).inverse();
  send(camera.stamp);
}

void PosePublisher::publishLost(const std_msgs::Header& camera) {
  if (sends_ && T_map_root_ && root_ != camera.frame_id) send(camera.stamp);
}

void PosePublisher::send(const ros::Time& stamp) {
  broadcaster_.sendTransform(makeTransform(makeHeader(stamp, parameters_.map_frame), root_, *T_map_root_));
}

void PosePublisher::reset() {
  T_map_root_.reset();
  path_.poses.clear();
}

void PosePublisher::addToPath(const std_msgs::Header& header, const Pose& T_map_camera) {
  const Pose step = T_map_last_.inverse() * T_map_camera;
  if (!path_.poses.empty() && step.translation().norm() < kPathStep_m && rotationAngle(step) < kPathStep_rad) return;
  T_map_last_ = T_map_camera;
  path_.header = header;
  path_.poses.emplace_back();
  path_.poses.back().header = header;
  path_.poses.back().pose = toMessage(T_map_camera);
  if (path_.poses.size() > kMaxPath) {
    for (size_t i = 0; i < kMaxPath / 2; ++i) path_.poses[i] = path_.poses[2 * i];
    path_.poses.erase(path_.poses.begin() + kMaxPath / 2, path_.poses.begin() + kMaxPath);
  }
  if (path_publisher_.getNumSubscribers() > 0) path_publisher_.publish(boost::make_shared<nav_msgs::Path>(path_));
}

}  // namespace depth_fusion
