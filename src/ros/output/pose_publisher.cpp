#include "ros/output/pose_publisher.h"

#include <ros/console.h>

#include <boost/make_shared.hpp>
#include <cstdint>

#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kPoseQueue = 10;
constexpr double kPathStep_m = 0.02;
constexpr double kPathStep_rad = 0.05;
constexpr size_t kMaxPath = 5000;
constexpr double kPathBytes_s = 1e5;  // a long path goes out less often
constexpr double kSayAgain_s = 60.0;  // what is wrong with the robot's tf, and stays so

}  // namespace

PosePublisher::PosePublisher(ros::NodeHandle handle, ros::NodeHandle private_handle,
                             const PoseParameters& parameters)
    : map_frame_(parameters.map_frame),
      transforms_(handle, parameters),
      odometry_(private_handle, parameters, transforms_),
      viewer_aids_(private_handle, parameters.map_frame, parameters.view_frame) {
  pose_publisher_ = private_handle.advertise<geometry_msgs::PoseWithCovarianceStamped>("pose", kPoseQueue);
  path_publisher_ = private_handle.advertise<nav_msgs::Path>(
      "path", 1, [this](const ros::SingleSubscriberPublisher& viewer) {
        const std::lock_guard<std::mutex> lock(path_mutex_);
        if (!path_.poses.empty()) viewer.publish(path_);
      });
}

void PosePublisher::publish(const std_msgs::Header& camera, const TrackingResult& tracked) {
  const Pose& T_map_camera = tracked.T_W_D;
  transforms_.take(camera, T_map_camera);
  odometry_.publish(camera, tracked);
  viewer_aids_.showTracked(camera.stamp, T_map_camera);
  publishMessage(camera, T_map_camera, tracked.covariance + tracked.drift);
  addToPath(makeHeader(camera.stamp, map_frame_), T_map_camera);
}

void PosePublisher::publishLost(const std_msgs::Header& camera, const std::optional<MotionPrior>& bridged,
                                const std::string& text) {
  if (bridged) publishMessage(camera, bridged->T_W_D, *bridged->covariance);
  viewer_aids_.showSign(text);
}

void PosePublisher::publishMessage(const std_msgs::Header& camera, const Pose& T_map_camera,
                                   const Matrix6d& covariance) {
  auto pose = boost::make_shared<geometry_msgs::PoseWithCovarianceStamped>();
  pose->header = makeHeader(camera.stamp, map_frame_);
  pose->pose = toMessage(T_map_camera, covariance);
  pose_publisher_.publish(pose);
}

void PosePublisher::reset() {
  transforms_.reset();
  odometry_.reset();
  const std::lock_guard<std::mutex> lock(path_mutex_);
  if (path_.poses.empty()) return;
  path_.poses.clear();
  publishPath();
}

void PosePublisher::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const std::string problem = transforms_.problem();
  if (problem.empty()) return;
  status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, problem);
  ROS_WARN_STREAM_THROTTLE(kSayAgain_s, problem);
}

void PosePublisher::correct(const Corrections& corrections) {
  odometry_.correct(corrections);
  const std::lock_guard<std::mutex> lock(path_mutex_);
  for (geometry_msgs::PoseStamped& pose : path_.poses)
    pose.pose = toMessage(corrections.corrected({pose.header.stamp.toSec(), fromMessage(pose.pose)}));
  if (!path_.poses.empty()) publishPath();
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
  if (path_publisher_.getNumSubscribers() == 0) return;
  const ros::WallTime now = ros::WallTime::now();
  const double period_s = ros::serialization::serializationLength(path_) / kPathBytes_s;
  if ((now - last_path_).toSec() < period_s) return;
  last_path_ = now;
  publishPath();
}

void PosePublisher::publishPath() { path_publisher_.publish(boost::make_shared<nav_msgs::Path>(path_)); }

}  // namespace depth_fusion
