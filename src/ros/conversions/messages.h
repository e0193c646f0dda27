// The core's data as ROS messages.
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseWithCovariance.h>
#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>
#include <string>

#include "depth_fusion/geometry/lens_distortion.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Throws Error for a stamp that ROS has no time for. 0, which means "no time" in ROS, becomes the smallest
// time.
ros::Time toRosTime(double stamp_s);

std_msgs::Header makeHeader(const ros::Time& stamp, const std::string& frame_id);

// A copy of the pixels.
sensor_msgs::Image makeImage(const std_msgs::Header& header, const cv::Mat& pixels,
                             const std::string& encoding);
// CV_8UC3 BGR as bgr8, CV_8UC1 as mono8. Throws Error for other types.
sensor_msgs::Image makeColorImage(const std_msgs::Header& header, const cv::Mat& color);

// Millimetres in 16 bits as 16UC1, anything else in metres as 32FC1.
sensor_msgs::Image makeDepthImage(const std_msgs::Header& header, const cv::Mat& depth, double unit_m);

sensor_msgs::CameraInfo makeCameraInfo(const std_msgs::Header& header, const CameraIntrinsics& camera,
                                       const LensDistortion& lens = {});

geometry_msgs::Pose toMessage(const Pose& pose);
// The covariance of the twist (rotation, translation) applied to the pose on the left, in ROS's order
// (translation first).
geometry_msgs::PoseWithCovariance toMessage(const Pose& pose, const Matrix6d& covariance);
// T_header.frame_id_child.
geometry_msgs::TransformStamped makeTransform(const std_msgs::Header& header, const std::string& child,
                                              const Pose& pose);
Pose fromMessage(const geometry_msgs::Transform& transform);

}  // namespace depth_fusion
