#include "ros/output/camera_tree.h"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "depth_fusion/common/error.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kQueue = 100;
// A robot's frames come on two topics and from several nodes.
constexpr double kSettled_s = 1.0;
constexpr double kMaxSettling_s = 3.0;
constexpr double kTransformTimeout_s = 0.1;
constexpr double kPoll_s = 0.002;

}  // namespace

CameraTree::CameraTree(ros::NodeHandle handle, const std::string& map_frame) : map_frame_(map_frame) {
  const auto subscribe = [&](const std::string& topic, bool is_static) {
    return handle.subscribe<tf2_msgs::TFMessage>(
        topic, kQueue,
        [this, is_static](const tf2_msgs::TFMessage::ConstPtr& message) { receive(*message, is_static); });
  };
  subscriber_ = subscribe("/tf", false);
  static_subscriber_ = subscribe("/tf_static", true);
}

void CameraTree::leaveOut(const std::string& child) {
  const std::lock_guard<std::mutex> lock(mutex_);
  left_out_ = child;
}

void CameraTree::receive(const tf2_msgs::TFMessage& message, bool is_static) {
  const ros::Time now = ros::Time::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (now < std::exchange(last_received_, now)) buffer_.clear();  // a simulated clock went back
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    if (transform.header.frame_id == map_frame_ && transform.child_frame_id == left_out_) continue;
    if (!buffer_._frameExists(transform.child_frame_id)) grown_ = ros::WallTime::now();
    buffer_.setTransform(transform, "tf", is_static);
  }
}

CameraTree::Root CameraTree::rootOf(const std::string& camera_frame) const {
  Root root{camera_frame};
  for (std::string parent; buffer_._getParent(root.frame, ros::Time(0), parent); root.frame = parent) {
    if (parent != map_frame_) continue;
    root.in_map = true;
    break;
  }
  return root;
}

CameraTree::Root CameraTree::settledRootOf(const std::string& camera_frame) const {
  // The wall's clock counts: a simulated one may stand still.
  const ros::WallTime begin = ros::WallTime::now();
  Root root = rootOf(camera_frame);
  for (ros::WallTime now = begin; othersPublish() && (now - begin).toSec() < kMaxSettling_s;
       now = ros::WallTime::now()) {
    const bool stands_alone = root.frame == camera_frame && !root.in_map;
    const ros::WallTime quiet_since = stands_alone ? std::max(begin, grown()) : grown();
    if ((now - quiet_since).toSec() > kSettled_s) break;
    ros::WallDuration(kPoll_s).sleep();
    root = rootOf(camera_frame);
  }
  return root;
}

ros::WallTime CameraTree::grown() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return grown_;
}

bool CameraTree::othersPublish() const {
  std::vector<std::string> frames;
  buffer_._getFrameStrings(frames);
  // This process publishes on /tf itself.
  return !frames.empty() || static_subscriber_.getNumPublishers() > 0 || subscriber_.getNumPublishers() > 1;
}

Pose CameraTree::cameraIn(const std::string& frame, const std_msgs::Header& camera) const {
  if (frame == camera.frame_id) return Pose::Identity();
  const ros::WallTime give_up = ros::WallTime::now() + ros::WallDuration(kTransformTimeout_s);
  while (!buffer_.canTransform(frame, camera.frame_id, camera.stamp) && ros::WallTime::now() < give_up)
    ros::WallDuration(kPoll_s).sleep();
  try {
    return fromMessage(buffer_.lookupTransform(frame, camera.frame_id, camera.stamp).transform);
  } catch (const tf2::TransformException& error) {
    throw Error(std::string("tf: ") + error.what());
  }
}

}  // namespace depth_fusion
