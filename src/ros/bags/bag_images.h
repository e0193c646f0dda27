// Images of a bag, of either message type.
#pragma once

#include "ros/bags/bag_file.h"
#include "ros/conversions/image_conversions.h"

namespace depth_fusion {

struct BagImage {
  std::string name;  // "file.bag: /topic", for messages
  double received_s = 0.0;
  double stamp_s = 0.0;  // of the header or, where that is zero, received_s
  std::string frame_id;
  sensor_msgs::ImageConstPtr raw;                   // null on a compressed topic
  sensor_msgs::CompressedImageConstPtr compressed;  // null on a raw topic
};

// Throws Error naming bag and topic if the message cannot be read.
BagImage readImage(const rosbag::MessageInstance& place, const rosbag::Bag& bag);

// Throw Error as the conversions do.
DepthImage toDepth(const BagImage& image);
cv::Mat toColor(const BagImage& image);

}  // namespace depth_fusion
