// sensor_msgs images as the core takes them. `topic` begins the message of every Error. Images from raw
// messages may use the message's memory: they are valid as long as it is, and not to be changed.
#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>
#include <string>

#include "depth_fusion/geometry/lens_distortion.h"

namespace depth_fusion {

struct DepthImage {
  cv::Mat image;  // CV_16UC1 or CV_32FC1 in units of unit_m; 0, NaN = none
  double unit_m = 1.0;
};

// Takes 16UC1 and mono16 (millimetres) and 32FC1 (metres).
DepthImage depthFromImage(const sensor_msgs::Image& message, const std::string& topic);

// Takes what compressed_depth_image_transport sends as png (16UC1, or 32FC1 as quantised inverse depth), and
// a plain PNG of 16 bits (millimetres).
DepthImage depthFromCompressed(const sensor_msgs::CompressedImage& message, const std::string& topic);

// Gives rgb8, bgr8, rgba8 and bgra8 as CV_8UC3 BGR, and mono8 as CV_8UC1.
cv::Mat colorFromImage(const sensor_msgs::Image& message, const std::string& topic);

// Gives jpeg or png as CV_8UC3 BGR or CV_8UC1.
cv::Mat colorFromCompressed(const sensor_msgs::CompressedImage& message, const std::string& topic);

// Reads the projection P for a rectified image (image_rect*), the camera matrix K for another.
CameraIntrinsics cameraFromInfo(const sensor_msgs::CameraInfo& info, const std::string& image_topic);

// Says what the lens does to the image; nothing to a rectified one. Throws Error for a model that is neither
// plumb_bob nor rational_polynomial.
LensDistortion distortionFromInfo(const sensor_msgs::CameraInfo& info, const std::string& image_topic);

}  // namespace depth_fusion
