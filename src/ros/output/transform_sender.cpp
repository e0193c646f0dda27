#include "ros/output/transform_sender.h"

#include <algorithm>
#include <cmath>

#include "depth_fusion/frames/known_attitude.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr double kPeriod_s = 0.05;
constexpr size_t kMaxWaiting = 300;          // poses, of 10 s
constexpr double kLateOdometry_s = 0.5;      // older than the camera by more is a problem
constexpr double kStandingOdometry_s = 1.0;  // without news, before poses go on without it
constexpr double kMoved = 1e-3;              // of a camera's pose in the root, more than rounding
constexpr double kSameClock_s = 10.0;        // stamps farther from ROS time are another clock's
constexpr double kAhead_s = 0.5;             // and images that are ahead of it by more are, too

std::string tenths(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f", value);
  return text;
}

std::string otherClockText(double lag_s, const std::string& sent) {
  return "the images' stamps are " + tenths(std::abs(lag_s)) + " s " + (lag_s > 0.0 ? "behind" : "ahead of") +
         " ROS time, in which odometry on tf is; " + sent +
         " goes by the odometry that is there when a pose comes, which is off by what the robot moves "
         "meanwhile; let the camera's driver stamp in ROS time, or synchronise the clocks (chrony)";
}

}  // namespace

TransformSender::TransformSender(ros::NodeHandle handle, const PoseParameters& parameters)
    : parameters_(parameters),
      tree_(handle, parameters.map_frame),
      timer_(callbacks_.createWallTimer(handle, ros::WallDuration(kPeriod_s),
                                        [this](const ros::WallTimerEvent&) { sendAhead(); })) {}

Pose TransformSender::startPose(const std_msgs::Header& camera,
                                const std::optional<Eigen::Vector3d>& up_camera) {
  if (!hasRoot()) tree_.awaitGrown(camera.frame_id);
  const std::lock_guard<std::mutex> lock(mutex_);
  followRoot(camera.frame_id);
  if (root_.frame != camera.frame_id) {
    if (const auto at_stamp = tree_.cameraIn(root_.frame, camera)) return *at_stamp;
    if (const auto newest = tree_.newest(root_.frame, camera.frame_id)) return newest->T_frame_camera;
  }
  if (!parameters_.level_start) return Pose::Identity();
  return levelPose(up_camera.value_or(kCameraUp));
}

std::optional<TransformSender::Body> TransformSender::baseOf(const std::string& camera_frame) const {
  for (const std::string& base :
       {parameters_.base_frame, std::string("base_link"), std::string("base_footprint")}) {
    if (base.empty()) continue;
    if (const auto placed = tree_.newest(base, camera_frame)) return Body{base, placed->T_frame_camera};
  }
  return std::nullopt;
}

std::optional<Pose> TransformSender::cameraOnBase(const std::string& camera_frame) const {
  const std::optional<Body> base = baseOf(camera_frame);
  return base ? std::optional<Pose>(base->T_body_camera) : std::nullopt;
}

std::optional<Pose> TransformSender::cameraIn(const std::string& frame,
                                              const std::string& camera_frame) const {
  const auto placed = tree_.newest(frame, camera_frame);
  return placed ? std::optional<Pose>(placed->T_frame_camera) : std::nullopt;
}

std::optional<OdometryReading> TransformSender::odometry(const std_msgs::Header& camera) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (root_.frame.empty() || root_.in_map || !moves_ || has_other_clock_) return std::nullopt;
  if (const auto at_stamp = tree_.cameraIn(root_.frame, camera))
    return OdometryReading{camera.stamp.toSec(), *at_stamp};
  const auto newest = tree_.newest(root_.frame, camera.frame_id);
  if (!newest || newest->stamp.isZero()) return std::nullopt;
  return OdometryReading{newest->stamp.toSec(), newest->T_frame_camera};
}

TransformSender::Body TransformSender::bodyOf(const std::string& camera_frame) const {
  if (const std::optional<Body> base = baseOf(camera_frame)) return *base;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!moves_ && mounting_) return {root_.frame, *mounting_};
  return {camera_frame, Pose::Identity()};
}

bool TransformSender::hasRoot() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !root_.frame.empty();
}

void TransformSender::followRoot(const std::string& camera_frame) {
  const std::string& given = parameters_.givenRoot();
  const CameraTree::Root root = given.empty() ? tree_.rootOf(camera_frame) : CameraTree::Root{given};
  if (root == root_) return;
  if (!root_.frame.empty())
    ROS_WARN(
        "the camera's tree on tf has changed: %s at the top, no longer %s; the map stays as it began. Who "
        "listened before may know %s -> %s still; give odom_frame or base_frame to be sure from the start",
        root.frame.c_str(), root_.frame.c_str(), parameters_.map_frame.c_str(), root_.frame.c_str());
  takeRoot(root);
}

void TransformSender::takeRoot(const CameraTree::Root& root) {
  root_ = root;
  has_other_clock_ = false;
  T_map_root_.reset();
  mounting_.reset();
  moves_ = root.frame == parameters_.odom_frame || isOdometry(root.frame);
  if (!root.in_map) return tree_.leaveOut(root.frame);
  ROS_ERROR(
      "somebody else publishes %s -> %s on tf; the tracker's poses go out as messages only. Let it map at "
      "those poses (tracking: external), or choose another map_frame",
      parameters_.map_frame.c_str(), root.frame.c_str());
}

void TransformSender::take(const std_msgs::Header& camera, const Pose& T_map_camera) {
  const std::lock_guard<std::mutex> lock(mutex_);
  followRoot(camera.frame_id);
  if (!parameters_.publish_tf || root_.in_map) return;
  last_ = Tracked{camera, T_map_camera};
  last_taken_ = ros::Time::now();
  const auto placed = tree_.newest(root_.frame, camera.frame_id);
  if (placed && !movesInRoot(placed->T_frame_camera))
    return send(camera.stamp, root_.frame, T_map_camera * placed->T_frame_camera.inverse());
  has_other_clock_ = placed && isOtherClock(placed->stamp);
  if (has_other_clock_) {
    waiting_.clear();
    T_map_root_ = T_map_camera * placed->T_frame_camera.inverse();
    return;
  }
  waiting_.push_back(*last_);
  if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
}

bool TransformSender::movesInRoot(const Pose& T_root_camera) {
  if (!mounting_) mounting_ = T_root_camera;
  moves_ = moves_ || !mounting_->isApprox(T_root_camera, kMoved);
  return moves_;
}

bool TransformSender::isOtherClock(const ros::Time& odometry) const {
  const bool is_ros_time = lag_s() > -kAhead_s && lag_s() < kSameClock_s;
  return !is_ros_time && (has_other_clock_ || std::abs(secondsBetween(odometry, last_taken_)) < kSameClock_s);
}

void TransformSender::reset() {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_.reset();
  has_other_clock_ = false;
  waiting_.clear();
  T_map_root_.reset();
}

void TransformSender::sendAhead() {
  const std::lock_guard<std::mutex> lock(mutex_);
  useNewestOdometry();
  if (!T_map_root_) return;
  const ros::Time stamp = robotTime() + ros::Duration(parameters_.transform_tolerance_s);
  const bool clock_went_back = secondsBetween(stamp, last_sent_) > 1.0;
  if (stamp <= last_sent_ && !clock_went_back) return;  // a simulated clock stands still
  last_sent_ = stamp;
  send(stamp, root_.frame, *T_map_root_);
}

void TransformSender::useNewestOdometry() {
  if (waiting_.empty() && !has_other_clock_) return;
  const std::string camera_frame = last_->camera.frame_id;
  const auto placed = tree_.newest(root_.frame, camera_frame);
  if (placed && (!odometry_ || placed->stamp != odometry_->stamp)) odometry_came_ = ros::WallTime::now();
  odometry_ = placed;
  for (auto pose = waiting_.rbegin(); pose != waiting_.rend(); ++pose) {
    const auto T_root_camera = tree_.cameraIn(root_.frame, pose->camera);
    if (!T_root_camera) continue;
    T_map_root_ = pose->T_map_camera * T_root_camera->inverse();
    waiting_.erase(waiting_.begin(), pose.base());
    return;
  }
  // Odometry that has ended stands still where it is, and so the robot's pose is right at least.
  if (odometry_ && (ros::WallTime::now() - odometry_came_).toSec() > kStandingOdometry_s)
    T_map_root_ = last_->T_map_camera * odometry_->T_frame_camera.inverse();
}

void TransformSender::sendLeaf(const ros::Time& stamp, const std::string& frame, const Pose& T_map_frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (parameters_.publish_tf && !root_.in_map) send(stamp, frame, T_map_frame);
}

void TransformSender::send(const ros::Time& stamp, const std::string& child, const Pose& T_map_child) {
  broadcaster_.sendTransform(makeTransform(makeHeader(stamp, parameters_.map_frame), child, T_map_child));
}

ros::Time TransformSender::robotTime() const {
  const ros::Time now = ros::Time::now();
  if (has_other_clock_ || std::abs(lag_s()) < kSameClock_s) return now;
  return ros::Time(std::max(now.toSec() - lag_s(), 0.0));
}

double TransformSender::lag_s() const { return secondsBetween(last_->camera.stamp, last_taken_); }

std::string TransformSender::problem() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (waiting_.empty() && !has_other_clock_) return "";
  const std::string way = root_.frame + " -> " + last_->camera.frame_id;
  if (!odometry_)
    return "tf does not connect " + way +
           ", so that no transform is sent; is odom_frame or base_frame right?";
  const double age_s = secondsBetween(odometry_->stamp, robotTime());
  if (age_s < kLateOdometry_s)
    return has_other_clock_ ? otherClockText(lag_s(), parameters_.map_frame + " -> " + root_.frame) : "";
  return "odometry on tf (" + way + ") is " + tenths(age_s) + " s old; mapping goes on without it, and " +
         parameters_.map_frame + " -> " + root_.frame + " with the last; does the robot's odometry run?";
}

}  // namespace depth_fusion
