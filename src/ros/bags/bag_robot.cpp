#include "ros/bags/bag_robot.h"

#include <sensor_msgs/Imu.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <utility>

#include "ros/bags/bag_transforms.h"
#include "ros/conversions/imu_conversion.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr double kWholeBag_s = 1e7;
constexpr char kImuType[] = "sensor_msgs/Imu";

std::optional<Pose> lookUp(const tf2::BufferCore& tf, const std::string& target, const std::string& source,
                           const ros::Time& stamp) {
  if (!tf.canTransform(target, source, stamp)) return std::nullopt;
  return fromMessage(tf.lookupTransform(target, source, stamp).transform);
}

}  // namespace

BagRobot::BagRobot(const BagFiles& bags, const std::string& camera_frame)
    : camera_frame_(withoutSlash(camera_frame)), tf_(ros::Duration(kWholeBag_s)) {
  addTransforms(bags, tf_);
  findTree();
  for (const BagTopic& topic : bags.topics()) {
    if (topic.type == kImuType) readImu(bags, topic.name);
  }
  std::stable_sort(imu_.begin(), imu_.end(),
                   [](const ImuReading& a, const ImuReading& b) { return a.stamp_s < b.stamp_s; });
}

void BagRobot::findTree() {
  std::string root = camera_frame_;
  for (std::string parent; tf_._getParent(root, ros::Time(0), parent); root = parent) {
    if (isOdometry(parent)) odometry_frame_ = parent;
  }
  for (const char* base : {"base_footprint", "base_link"}) {
    if (!T_B_D_) T_B_D_ = lookUp(tf_, base, camera_frame_, ros::Time(0));
  }
  if (!odometry_frame_.empty()) description_ = "odometry in " + odometry_frame_;
}

void BagRobot::readImu(const BagFiles& bags, const std::string& topic) {
  rosbag::View view;
  bags.addTo(view, {topic});
  std::optional<Eigen::Matrix3d> R_D_I;
  for (const rosbag::MessageInstance& place : view) {
    const auto message = readMessage<sensor_msgs::Imu>(place, bags);
    if (!R_D_I) {
      const std::string frame = withoutSlash(message->header.frame_id);
      const auto T_D_I =
          frame == camera_frame_ ? Pose(Pose::Identity()) : lookUp(tf_, camera_frame_, frame, ros::Time(0));
      if (!T_D_I) return;
      R_D_I = T_D_I->linear();
      description_ += (description_.empty() ? "" : ", ") + ("inertial sensor " + topic);
    }
    imu_.push_back(toReading(*message, *R_D_I));
  }
}

MotionReadings BagRobot::until(double stamp_s) {
  MotionReadings readings;
  readings.T_B_D = T_B_D_;
  for (; next_imu_ < imu_.size() && imu_[next_imu_].stamp_s <= stamp_s; ++next_imu_)
    readings.imu.push_back(imu_[next_imu_]);
  if (odometry_frame_.empty()) return readings;
  if (const auto T_O_D = lookUp(tf_, odometry_frame_, camera_frame_, toRosTime(stamp_s)))
    readings.odometry.push_back({stamp_s, *T_O_D});
  return readings;
}

}  // namespace depth_fusion
