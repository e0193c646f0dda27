// Images of a bag, of either message type.
#pragma once

#include "ros/bags/bag_file.h"
#include "ros/conversions/image_message.h"

namespace depth_fusion {

struct BagImage {
  std::string name;  // "file.bag: /topic", for messages
  double received_s = 0.0;
  double stamp_s = 0.0;  // of the header or, where that is zero, received_s
  ImageMessage message;
};

// Throws Error naming bag and topic if the message cannot be read.
BagImage readImage(const rosbag::MessageInstance& place, const rosbag::Bag& bag);

// Decode the image into memory of its own. Throw Error as the conversions do.
DepthImage toDepth(const BagImage& image);
cv::Mat toColor(const BagImage& image);

}  // namespace depth_fusion
