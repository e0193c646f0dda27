// The core's data as ROS messages.
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseWithCovariance.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistWithCovariance.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>
#include <string>

#include "depth_fusion/geometry/lens_distortion.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// The time between any two stamps, in seconds. ros::Time's own difference throws where they are 68 years
// apart, which the stamp of a faulty driver may be.
inline double secondsBetween(const ros::Time& from, const ros::Time& to) { return to.toSec() - from.toSec(); }

// The frame's name as tf2 takes it; tf had them with a slash before.
std::string withoutSlash(const std::string& frame);

// Whether the frame is one of odometry by its name (REP 105).
inline bool isOdometry(const std::string& frame) { return frame.find("odom") != std::string::npos; }

// Throws Error for a stamp that ROS has no time for. 0, which means "no time" in ROS, becomes the smallest
// time.
ros::Time toRosTime(double stamp_s);

std_msgs::Header makeHeader(const ros::Time& stamp, const std::string& frame_id);

// Copies the pixels.
sensor_msgs::Image makeImage(const std_msgs::Header& header, const cv::Mat& pixels,
                             const std::string& encoding);
// Makes bgr8 of CV_8UC3 BGR and mono8 of CV_8UC1. Throws Error for other types.
sensor_msgs::Image makeColorImage(const std_msgs::Header& header, const cv::Mat& color);

// Makes 16UC1 of millimetres in 16 bits, and 32FC1 in metres of anything else.
sensor_msgs::Image makeDepthImage(const std_msgs::Header& header, const cv::Mat& depth, double unit_m);

sensor_msgs::CameraInfo makeCameraInfo(const std_msgs::Header& header, const CameraIntrinsics& camera,
                                       const LensDistortion& lens = {});

geometry_msgs::Pose toMessage(const Pose& pose);
// `covariance` is that of the twist (rotation, translation) applied to the pose on the left; the message has
// it in ROS's order, translation first.
geometry_msgs::PoseWithCovariance toMessage(const Pose& pose, const Matrix6d& covariance);
// The same of a velocity (rotation, rad/s; translation, m/s).
geometry_msgs::TwistWithCovariance toMessage(const Vector6d& velocity, const Matrix6d& covariance);
// `pose` maps points of the frame `child` into header.frame_id.
geometry_msgs::TransformStamped makeTransform(const std_msgs::Header& header, const std::string& child,
                                              const Pose& pose);
Pose fromMessage(const geometry_msgs::Transform& transform);
// Throws Error for a pose that is none: numbers that are not finite, a quaternion of zeros.
Pose fromMessage(const geometry_msgs::Pose& pose);

}  // namespace depth_fusion
