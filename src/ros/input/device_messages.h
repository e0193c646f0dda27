// A camera's images as messages.
#pragma once

#include <sensor_msgs/Image.h>

#include <memory>

#include "depth_fusion/acquisition/rgbd_device.h"

namespace depth_fusion {

// Makes a message around the pixels, without a copy; the buffers have them back when the last reader is done.
// Depth in units that ROS has no 16 bits for is copied as metres in 32 bits.
sensor_msgs::ImagePtr toMessage(DeviceImage image, const std_msgs::Header& header,
                                std::shared_ptr<FrameBuffers> buffers);

}  // namespace depth_fusion
