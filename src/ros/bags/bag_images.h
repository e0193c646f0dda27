// Images of bags, of either message type.
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
BagImage readImage(const rosbag::MessageInstance& place, const BagFiles& bags);

// Decode the image into memory of its own. Throw Error as the conversions do.
DepthImage toDepth(const BagImage& image);
cv::Mat toColor(const BagImage& image);

// What the first images of a topic that can be decoded have in common.
struct ImageSample {
  cv::Size size;                    // the usual one
  std::string frame_id;             // of an image of this size
  double lead_s = 0.0;              // by how much stamps are ahead of the receipt, in the median
  bool is_in_unusual_unit = false;  // as DepthImage has it
};

// Looks at some of the topic's images, past those that cannot be decoded. Throws Error with the reason of the
// first if none can be.
ImageSample sampleDepth(const BagFiles& bags, const std::string& topic);
ImageSample sampleColor(const BagFiles& bags, const std::string& topic);

}  // namespace depth_fusion
