#include "ros/conversions/message_pixels.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

bool hostIsBigEndian() {
  const uint16_t one = 1;
  return *reinterpret_cast<const unsigned char*>(&one) == 0;
}

void swapBytes(cv::Mat& image) {
  const size_t size = image.elemSize1();
  for (unsigned char* value = image.data; value < image.data + image.total() * image.elemSize();
       value += size) {
    std::reverse(value, value + size);
  }
}

}  // namespace

cv::Mat pixelsOf(const sensor_msgs::Image& message, int type, const std::string& topic) {
  check(message.width > 0 && message.height > 0, topic + ": the image is empty");
  const size_t row_size = size_t{message.width} * CV_ELEM_SIZE(type);
  const size_t needed = size_t{message.step} * (message.height - 1) + row_size;
  check(message.step >= row_size && message.data.size() >= needed,
        topic + ": the image holds " + std::to_string(message.data.size()) + " bytes with a step of " +
            std::to_string(message.step) + ", too few for " + std::to_string(message.width) + "x" +
            std::to_string(message.height) + " " + message.encoding);
  const bool swaps = CV_ELEM_SIZE1(type) > 1 && (message.is_bigendian != 0) != hostIsBigEndian();
  const cv::Size size(static_cast<int>(message.width), static_cast<int>(message.height));
  if (!swaps && message.step % CV_ELEM_SIZE1(type) == 0)
    return cv::Mat(size, type, const_cast<unsigned char*>(message.data.data()), message.step);
  cv::Mat image(size, type);
  for (int row = 0; row < image.rows; ++row) {
    std::memcpy(image.ptr(row), message.data.data() + size_t{message.step} * row, row_size);
  }
  if (swaps) swapBytes(image);
  return image;
}

}  // namespace depth_fusion
