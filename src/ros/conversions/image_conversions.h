// sensor_msgs images as the core takes them. `topic` begins the message of every Error. Images from raw
// messages may use the message's memory: they are valid as long as it is, and not to be changed.
#pragma once

#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>
#include <string>

namespace depth_fusion {

struct DepthImage {
  cv::Mat image;  // CV_16UC1 or CV_32FC1 in units of unit_m; 0, NaN = none
  double unit_m = 1.0;
  bool is_in_unusual_unit = false;  // unit_m is a guess: as metres, the depth would be beyond all rooms
};

// Takes 16UC1, mono16, 16SC1 and Z16 (millimetres) and 32FC1 and 64FC1 (metres, or millimetres where metres
// make no sense).
DepthImage depthFromImage(const sensor_msgs::Image& message, const std::string& topic);

// Takes what compressed_depth_image_transport sends, as png or rvl (16UC1, or 32FC1 as quantised inverse
// depth), and a plain PNG of 16 bits (millimetres). The data tell a PNG, whatever the format says.
DepthImage depthFromCompressed(const sensor_msgs::CompressedImage& message, const std::string& topic);

// Gives rgb, bgr, rgba, bgra, bayer_* (8 and 16 bits each), yuv422, yuv422_yuy2 and 8UC3 (taken for bgr8) as
// CV_8UC3 BGR, and mono8, mono16 and 8UC1 as CV_8UC1.
cv::Mat colorFromImage(const sensor_msgs::Image& message, const std::string& topic);

// Gives jpeg or png, of a Bayer pattern, too, as CV_8UC3 BGR or CV_8UC1.
cv::Mat colorFromCompressed(const sensor_msgs::CompressedImage& message, const std::string& topic);

}  // namespace depth_fusion
