#include "ros/input/image_topic.h"

#include <cstdint>

namespace depth_fusion {
namespace {

constexpr uint32_t kTopicQueue = 30;
constexpr char kRaw[] = "raw";

}  // namespace

std::string imageTopicName(ros::NodeHandle& handle, const std::string& image, const std::string& transport) {
  return handle.resolveName(image) + (transport == kRaw ? "" : "/" + transport);
}

ImageTopic::ImageTopic(ros::NodeHandle& handle, const std::string& name, const std::string& transport,
                       const Callback& callback) {
  if (transport == kRaw) {
    subscriber_ = handle.subscribe<sensor_msgs::Image>(name, kTopicQueue,
                                                       [callback](const sensor_msgs::ImageConstPtr& image) {
                                                         callback({image, nullptr});
                                                       });
  } else {
    subscriber_ = handle.subscribe<sensor_msgs::CompressedImage>(
        name, kTopicQueue, [callback](const sensor_msgs::CompressedImageConstPtr& image) {
          callback({nullptr, image});
        });
  }
}

}  // namespace depth_fusion
