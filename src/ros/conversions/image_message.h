// An image message of any type, raw, compressed or a point cloud, before it is decoded.
#pragma once

#include "ros/conversions/cloud_conversions.h"
#include "ros/conversions/image_conversions.h"

namespace depth_fusion {

struct ImageMessage {
  // One of them, or none.
  sensor_msgs::ImageConstPtr raw;
  sensor_msgs::CompressedImageConstPtr compressed;
  sensor_msgs::PointCloud2ConstPtr cloud = {};

  bool empty() const { return raw == nullptr && compressed == nullptr && cloud == nullptr; }
  // Only of a message that is not empty.
  const std_msgs::Header& header() const {
    return raw ? raw->header : compressed ? compressed->header : cloud->header;
  }
};

// Decode a message that is not empty; a cloud is to be organised. What was raw may use the message's memory.
// `topic` begins the message of every Error.
DepthImage toDepth(const ImageMessage& message, const std::string& topic);
cv::Mat toColor(const ImageMessage& message, const std::string& topic);

}  // namespace depth_fusion
