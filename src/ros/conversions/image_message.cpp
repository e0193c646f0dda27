#include "ros/conversions/image_message.h"

#include "depth_fusion/common/error.h"

namespace depth_fusion {

DepthImage toDepth(const ImageMessage& message, const std::string& topic) {
  if (message.raw != nullptr) return depthFromImage(*message.raw, topic);
  if (message.compressed != nullptr) return depthFromCompressed(*message.compressed, topic);
  check(isOrganised(*message.cloud), topic + ": a cloud is a list of points, not organised as an image");
  return {depthOfCloud(*message.cloud, topic)};
}

cv::Mat toColor(const ImageMessage& message, const std::string& topic) {
  if (message.raw != nullptr) return colorFromImage(*message.raw, topic);
  return message.cloud != nullptr ? colorOfCloud(*message.cloud)
                                  : colorFromCompressed(*message.compressed, topic);
}

}  // namespace depth_fusion
