#include "ros/conversions/image_conversions.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "common/io/image_file.h"
#include "depth_fusion/common/error.h"
#include "ros/conversions/message_pixels.h"

namespace depth_fusion {
namespace {

constexpr double kMillimetre_m = 0.001;
// The header that compressed_depth_image_transport puts before the PNG.
struct CompressedDepthHeader {
  int32_t format;
  float quant_a;
  float quant_b;
};
static_assert(sizeof(CompressedDepthHeader) == 12, "as on the wire");

// Too near, too far and unknown have numbers of their own in ROS (REP 118).
cv::Mat withoutInvalid(cv::Mat depth) {
  cv::Mat valid;
  cv::inRange(depth, 0.0, std::numeric_limits<float>::max(), valid);
  depth.setTo(std::numeric_limits<float>::quiet_NaN(), valid == 0);
  return depth;
}

cv::Mat decodePng16(const unsigned char* data, size_t size, const std::string& topic) {
  cv::Mat image = decodeImage(data, size, topic);
  check(image.type() == CV_16UC1, topic +
                                      ": compressed depth must be a PNG of one channel with 16 bits, not " +
                                      cv::typeToString(image.type()));
  return image;
}

// The transport stores A / depth + B; 0 is no depth.
cv::Mat depthFromInverse(const cv::Mat& quantised, const CompressedDepthHeader& header) {
  cv::Mat depth(quantised.size(), CV_32FC1);
  std::transform(quantised.begin<uint16_t>(), quantised.end<uint16_t>(), depth.begin<float>(),
                 [&](uint16_t value) {
                   return value == 0 ? std::numeric_limits<float>::quiet_NaN()
                                     : header.quant_a / (value - header.quant_b);
                 });
  return withoutInvalid(depth);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

DepthImage depthFromImage(const sensor_msgs::Image& message, const std::string& topic) {
  if (message.encoding == "32FC1") return {withoutInvalid(pixelsOf(message, CV_32FC1, topic).clone()), 1.0};
  check(message.encoding == "16UC1" || message.encoding == "mono16",
        topic + ": encoding '" + message.encoding + "' is no depth; 16UC1, mono16 and 32FC1 are accepted");
  return {pixelsOf(message, CV_16UC1, topic), kMillimetre_m};
}

DepthImage depthFromCompressed(const sensor_msgs::CompressedImage& message, const std::string& topic) {
  const size_t size = message.data.size();
  if (!contains(message.format, "compressedDepth")) {
    check(contains(message.format, "png"),
          topic + ": format '" + message.format +
              "' is no depth; compressedDepth as png and png of 16 bits are accepted");
    return {decodePng16(message.data.data(), size, topic), kMillimetre_m};
  }
  check(!contains(message.format, "rvl"),
        topic + ": format '" + message.format + "' is not accepted; record compressedDepth as png");
  CompressedDepthHeader header{};
  check(size > sizeof(header), topic + ": the compressed image is empty");
  std::memcpy(&header, message.data.data(), sizeof(header));
  const cv::Mat image = decodePng16(message.data.data() + sizeof(header), size - sizeof(header), topic);
  const std::string encoding = message.format.substr(0, message.format.find(';'));
  if (encoding == "32FC1") return {depthFromInverse(image, header), 1.0};
  check(encoding == "16UC1" || encoding == "mono16",
        topic + ": format '" + message.format + "' is no depth; 16UC1 and 32FC1 are accepted");
  return {image, kMillimetre_m};
}

}  // namespace depth_fusion
