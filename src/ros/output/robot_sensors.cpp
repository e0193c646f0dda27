#include "ros/output/robot_sensors.h"

#include <ros/console.h>

#include <cstdint>

#include "ros/conversions/imu_conversion.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kSensorQueue = 1000;
constexpr size_t kMaxReadings = 4000;  // messages, of 10 s of a fast sensor
constexpr double kRemindAfter_s = 60.0;

}  // namespace

RobotSensors::RobotSensors(ros::NodeHandle handle, const TransformSender& transforms)
    : transforms_(transforms),
      subscriber_(handle.subscribe<sensor_msgs::Imu>(
          "imu", kSensorQueue, [this](const sensor_msgs::Imu::ConstPtr& message) { receive(message); })) {}

void RobotSensors::receive(const sensor_msgs::Imu::ConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  messages_.push_back(message);
  if (messages_.size() > kMaxReadings) messages_.pop_front();
}

MotionReadings RobotSensors::until(const std_msgs::Header& camera, double stamp_s) {
  MotionReadings readings;
  const double shift_s = stamp_s - camera.stamp.toSec();
  if (auto odometry = transforms_.odometry(camera)) {
    odometry->stamp_s += shift_s;
    readings.odometry.push_back(*odometry);
  }
  readings.T_B_D = transforms_.cameraOnBase(camera.frame_id);
  const std::lock_guard<std::mutex> lock(mutex_);
  for (; !messages_.empty() && messages_.front()->header.stamp <= camera.stamp; messages_.pop_front()) {
    const sensor_msgs::Imu& message = *messages_.front();
    const auto T_I_D = transforms_.cameraIn(withoutSlash(message.header.frame_id), camera.frame_id);
    if (!T_I_D) {
      ROS_WARN_THROTTLE(kRemindAfter_s,
                        "the imu is in the frame '%s', which tf does not connect to '%s'; it is not used",
                        message.header.frame_id.c_str(), camera.frame_id.c_str());
      continue;
    }
    readings.imu.push_back(toReading(message, T_I_D->linear().transpose()));
    readings.imu.back().stamp_s += shift_s;
  }
  return readings;
}

}  // namespace depth_fusion
