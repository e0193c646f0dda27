// Messages for bags of any encoding.
#pragma once

#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <string>

namespace depth_fusion {

// The rows are `padding` bytes farther apart than needed.
inline sensor_msgs::Image imageMessage(const cv::Mat& pixels, const std::string& encoding, int padding = 0) {
  sensor_msgs::Image message;
  message.width = static_cast<uint32_t>(pixels.cols);
  message.height = static_cast<uint32_t>(pixels.rows);
  message.encoding = encoding;
  const size_t row_size = static_cast<size_t>(pixels.cols) * pixels.elemSize();
  message.step = static_cast<uint32_t>(row_size + static_cast<size_t>(padding));
  message.data.assign(size_t{message.step} * message.height, 0xee);
  for (int row = 0; row < pixels.rows; ++row) {
    std::memcpy(message.data.data() + size_t{message.step} * static_cast<size_t>(row), pixels.ptr(row),
                row_size);
  }
  return message;
}

inline sensor_msgs::CompressedImage compressedMessage(const cv::Mat& pixels, const std::string& ending,
                                                      const std::string& format) {
  sensor_msgs::CompressedImage message;
  message.format = format;
  cv::imencode(ending, pixels, message.data);
  return message;
}

// Compresses as compressed_depth_image_transport does: a header of an enum and two floats, then a PNG.
inline sensor_msgs::CompressedImage compressedDepthMessage(const cv::Mat& values, const std::string& format,
                                                           float quant_a = 0.0f, float quant_b = 0.0f) {
  sensor_msgs::CompressedImage message = compressedMessage(values, ".png", format);
  unsigned char header[12] = {};
  std::memcpy(header + 4, &quant_a, sizeof(quant_a));
  std::memcpy(header + 8, &quant_b, sizeof(quant_b));
  message.data.insert(message.data.begin(), header, header + sizeof(header));
  return message;
}

inline sensor_msgs::CameraInfo infoMessage(int width, int height, double focal_px) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<uint32_t>(width);
  info.height = static_cast<uint32_t>(height);
  info.K = {focal_px, 0.0, 5.5, 0.0, focal_px, 3.25, 0.0, 0.0, 1.0};
  info.P = {focal_px + 1.0, 0.0, 5.5, 0.0, 0.0, focal_px + 1.0, 3.25, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

// Writes the message as received delay_s after its stamp.
template <class Message>
void addToBag(rosbag::Bag& bag, const std::string& topic, double stamp_s, Message message,
              double delay_s = 0.0) {
  message.header.stamp = ros::Time(stamp_s);
  bag.write(topic, ros::Time(stamp_s + delay_s), message);
}

}  // namespace depth_fusion
