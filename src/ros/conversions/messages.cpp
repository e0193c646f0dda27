#include "ros/conversions/messages.h"

#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cstdint>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// A covariance in ROS's order.
boost::array<double, 36> translationFirst(const Matrix6d& covariance) {
  boost::array<double, 36> values;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column)
      values[static_cast<size_t>(6 * row + column)] = covariance((row + 3) % 6, (column + 3) % 6);
  }
  return values;
}

}  // namespace

std::string withoutSlash(const std::string& frame) {
  return frame.empty() || frame[0] != '/' ? frame : frame.substr(1);
}

ros::Time toRosTime(double stamp_s) {
  constexpr double kEndOfTime_s = 4294967296.0;
  check(stamp_s >= 0.0 && stamp_s < kEndOfTime_s,
        "ROS has stamps from 0 to 2^32 s; this frame's is " + std::to_string(stamp_s));
  return std::max(ros::Time(stamp_s), ros::TIME_MIN);
}

std_msgs::Header makeHeader(const ros::Time& stamp, const std::string& frame_id) {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = frame_id;
  return header;
}

sensor_msgs::Image makeImage(const std_msgs::Header& header, const cv::Mat& pixels,
                             const std::string& encoding) {
  sensor_msgs::Image image;
  image.header = header;
  image.width = static_cast<uint32_t>(pixels.cols);
  image.height = static_cast<uint32_t>(pixels.rows);
  image.encoding = encoding;
  image.step = static_cast<uint32_t>(pixels.cols * pixels.elemSize());
  image.data.reserve(size_t{image.step} * image.height);
  for (int row = 0; row < pixels.rows; ++row) {
    image.data.insert(image.data.end(), pixels.ptr(row), pixels.ptr(row) + image.step);
  }
  return image;
}

sensor_msgs::Image makeColorImage(const std_msgs::Header& header, const cv::Mat& color) {
  const bool is_gray = color.type() == CV_8UC1;
  check(is_gray || color.type() == CV_8UC3, "colour must be of type CV_8UC3 or CV_8UC1");
  return makeImage(header, color,
                   is_gray ? sensor_msgs::image_encodings::MONO8 : sensor_msgs::image_encodings::BGR8);
}

sensor_msgs::Image makeDepthImage(const std_msgs::Header& header, const cv::Mat& depth, double unit_m) {
  constexpr double kMillimetre_m = 0.001;
  if (depth.type() == CV_16UC1 && unit_m == kMillimetre_m)
    return makeImage(header, depth, sensor_msgs::image_encodings::TYPE_16UC1);
  cv::Mat metres;
  depth.convertTo(metres, CV_32F, unit_m);
  return makeImage(header, metres, sensor_msgs::image_encodings::TYPE_32FC1);
}

sensor_msgs::CameraInfo makeCameraInfo(const std_msgs::Header& header, const CameraIntrinsics& camera,
                                       const LensDistortion& lens) {
  sensor_msgs::CameraInfo info;
  info.header = header;
  info.width = static_cast<uint32_t>(camera.width);
  info.height = static_cast<uint32_t>(camera.height);
  info.distortion_model = lens.size() > 5 ? "rational_polynomial" : "plumb_bob";
  info.D = lens.empty() ? LensDistortion(5, 0.0) : lens;
  info.K = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

geometry_msgs::Pose toMessage(const Pose& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::Pose message;
  message.position.x = pose.translation().x();
  message.position.y = pose.translation().y();
  message.position.z = pose.translation().z();
  message.orientation.x = rotation.x();
  message.orientation.y = rotation.y();
  message.orientation.z = rotation.z();
  message.orientation.w = rotation.w();
  return message;
}

geometry_msgs::PoseWithCovariance toMessage(const Pose& pose, const Matrix6d& covariance) {
  // The twist turns about the origin of the outer frame; ROS means rotations about the pose itself.
  Pose to_pose = Pose::Identity();
  to_pose.translation() = -pose.translation();
  const Matrix6d shift = adjoint(to_pose);
  const Matrix6d about_pose = shift * covariance * shift.transpose();
  geometry_msgs::PoseWithCovariance message;
  message.pose = toMessage(pose);
  message.covariance = translationFirst(about_pose);
  return message;
}

geometry_msgs::TwistWithCovariance toMessage(const Vector6d& velocity, const Matrix6d& covariance) {
  geometry_msgs::TwistWithCovariance message;
  message.twist.angular.x = velocity[0];
  message.twist.angular.y = velocity[1];
  message.twist.angular.z = velocity[2];
  message.twist.linear.x = velocity[3];
  message.twist.linear.y = velocity[4];
  message.twist.linear.z = velocity[5];
  message.covariance = translationFirst(covariance);
  return message;
}

geometry_msgs::TransformStamped makeTransform(const std_msgs::Header& header, const std::string& child,
                                              const Pose& pose) {
  const geometry_msgs::Pose message = toMessage(pose);
  geometry_msgs::TransformStamped transform;
  transform.header = header;
  transform.child_frame_id = child;
  transform.transform.translation.x = message.position.x;
  transform.transform.translation.y = message.position.y;
  transform.transform.translation.z = message.position.z;
  transform.transform.rotation = message.orientation;
  return transform;
}

Pose fromMessage(const geometry_msgs::Transform& transform) {
  const auto& q = transform.rotation;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  pose.translation() =
      Eigen::Vector3d(transform.translation.x, transform.translation.y, transform.translation.z);
  return pose;
}

Pose fromMessage(const geometry_msgs::Pose& pose) {
  const auto& q = pose.orientation;
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  const Eigen::Vector3d position(pose.position.x, pose.position.y, pose.position.z);
  check(rotation.coeffs().allFinite() && position.allFinite() && rotation.norm() > 1e-6,
        "the pose is none: numbers that are not finite, or a quaternion of zeros");
  Pose result = Pose::Identity();
  result.linear() = rotation.normalized().toRotationMatrix();
  result.translation() = position;
  return result;
}

}  // namespace depth_fusion
