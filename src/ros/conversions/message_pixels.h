// The pixels of a raw image message.
#pragma once

#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>
#include <string>

namespace depth_fusion {

// The pixels, which are of OpenCV's `type`. Shares the message's memory if its byte order and step are those
// of an image here, and copies otherwise. Throws Error, which begins with `topic`, for an image that is empty
// or cut.
cv::Mat pixelsOf(const sensor_msgs::Image& message, int type, const std::string& topic);

}  // namespace depth_fusion
