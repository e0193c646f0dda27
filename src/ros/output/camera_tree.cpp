#include "ros/output/camera_tree.h"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kTfQueue = 100;
// A robot's frames come on two topics and from several nodes.
constexpr double kSettled_s = 1.0;
constexpr double kMaxSettling_s = 3.0;
constexpr double kPoll_s = 0.002;

}  // namespace

CameraTree::CameraTree(ros::NodeHandle handle, const std::string& map_frame) : map_frame_(map_frame) {
  const auto subscribe = [&](const std::string& topic, bool is_static) {
    return handle.subscribe<tf2_msgs::TFMessage>(
        topic, kTfQueue,
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
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::Time now = ros::Time::now();  // with the lock held, so that it goes back only if the clock does
  if (now < std::exchange(last_received_, now)) buffer_.clear();  // a simulated clock went back
  for (geometry_msgs::TransformStamped transform : message.transforms) {
    transform.header.frame_id = withoutSlash(transform.header.frame_id);
    transform.child_frame_id = withoutSlash(transform.child_frame_id);
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

void CameraTree::awaitGrown(const std::string& camera_frame) const {
  // The wall's clock counts: a simulated one may stand still.
  const ros::WallTime begin = ros::WallTime::now();
  for (ros::WallTime now = begin; othersPublish() && (now - begin).toSec() < kMaxSettling_s;
       now = ros::WallTime::now()) {
    const Root root = rootOf(camera_frame);
    const bool stands_alone = root.frame == camera_frame && !root.in_map;
    const ros::WallTime quiet_since = stands_alone ? std::max(begin, grown()) : grown();
    if (isOdometry(root.frame) || (now - quiet_since).toSec() > kSettled_s) return;
    ros::WallDuration(kPoll_s).sleep();
  }
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

std::optional<CameraTree::Placed> CameraTree::newest(const std::string& frame,
                                                     const std::string& camera_frame) const {
  return lookUp(frame, camera_frame, ros::Time(0));
}

std::optional<Pose> CameraTree::cameraIn(const std::string& frame, const std_msgs::Header& camera) const {
  const std::optional<Placed> placed = lookUp(frame, camera.frame_id, camera.stamp);
  return placed ? std::optional<Pose>(placed->T_frame_camera) : std::nullopt;
}

std::optional<CameraTree::Placed> CameraTree::lookUp(const std::string& frame,
                                                     const std::string& camera_frame,
                                                     const ros::Time& stamp) const {
  if (frame == camera_frame) return Placed{Pose::Identity(), ros::Time()};
  if (!buffer_.canTransform(frame, camera_frame, stamp)) return std::nullopt;
  try {
    const geometry_msgs::TransformStamped found = buffer_.lookupTransform(frame, camera_frame, stamp);
    return Placed{fromMessage(found.transform), found.header.stamp};
  } catch (const tf2::TransformException&) {  // tf has forgotten it meanwhile
    return std::nullopt;
  }
}

}  // namespace depth_fusion
