// An image message of either type, raw or compressed, before it is decoded.
#pragma once

#include "ros/conversions/image_conversions.h"

namespace depth_fusion {

struct ImageMessage {
  sensor_msgs::ImageConstPtr raw;                   // null if the image is compressed
  sensor_msgs::CompressedImageConstPtr compressed;  // null if the image is raw

  bool empty() const { return raw == nullptr && compressed == nullptr; }
  // Only of a message that is not empty.
  const std_msgs::Header& header() const { return raw ? raw->header : compressed->header; }
};

// Decode a message that is not empty. What was raw may use the message's memory. `topic` begins the message
// of every Error.
DepthImage toDepth(const ImageMessage& message, const std::string& topic);
cv::Mat toColor(const ImageMessage& message, const std::string& topic);

}  // namespace depth_fusion
