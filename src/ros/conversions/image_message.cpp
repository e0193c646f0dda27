#include "ros/conversions/image_message.h"

namespace depth_fusion {

DepthImage toDepth(const ImageMessage& message, const std::string& topic) {
  return message.raw ? depthFromImage(*message.raw, topic) : depthFromCompressed(*message.compressed, topic);
}

cv::Mat toColor(const ImageMessage& message, const std::string& topic) {
  return message.raw ? colorFromImage(*message.raw, topic) : colorFromCompressed(*message.compressed, topic);
}

}  // namespace depth_fusion
