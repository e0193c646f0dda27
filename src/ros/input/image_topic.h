// A topic of images, raw or compressed.
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <string>

#include "ros/conversions/image_message.h"

namespace depth_fusion {

// The resolved name of the topic on which `image`, as "depth/image", is published with that transport.
std::string imageTopicName(ros::NodeHandle& handle, const std::string& image, const std::string& transport);

class ImageTopic {
 public:
  using Callback = std::function<void(const ImageMessage&)>;

  // Subscribes the topic of that name. The callback gets one message at a time, in the order that they come
  // in, from the threads of the handle's callback queue.
  ImageTopic(ros::NodeHandle& handle, const std::string& name, const std::string& transport,
             const Callback& callback);
  // Waits for the callback in progress; there is none afterwards.
  ~ImageTopic() { subscriber_.shutdown(); }
  ImageTopic(const ImageTopic&) = delete;
  ImageTopic& operator=(const ImageTopic&) = delete;

  bool isPublished() const { return subscriber_.getNumPublishers() > 0; }

 private:
  ros::Subscriber subscriber_;
};

}  // namespace depth_fusion
