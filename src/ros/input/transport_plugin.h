// Transports of images that plugins of image_transport bring, beside those that are decoded here.
#pragma once

#include <image_transport/subscriber.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace depth_fusion {

// Throws Error, which names those that there are, if the transport of `image`, as "depth/image", is neither
// one of `own`, which are decoded here, nor one whose plugin is installed.
void checkTransport(const std::string& image, const std::string& transport,
                    const std::vector<std::string>& own);

// Subscribes `image`, as "depth/image", by that transport, which has a plugin: it decodes the images in the
// threads of the handle's callback queue, and reads its own parameters below depth/image_transport. Throws
// image_transport::Exception if it cannot.
image_transport::Subscriber subscribeByPlugin(
    const ros::NodeHandle& handle, const std::string& image, const std::string& transport,
    uint32_t queue_size, const std::function<void(const sensor_msgs::ImageConstPtr&)>& take);

}  // namespace depth_fusion
