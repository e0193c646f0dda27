#include "ros/conversions/image_conversions.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "common/io/image_file.h"
#include "common/lowered.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/common/percentile.h"
#include "ros/conversions/message_pixels.h"
#include "ros/conversions/rvl.h"

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

// Depth of no room if it is in metres, nor of any in millimetres if it is less.
bool isInMillimetres(const cv::Mat& depth) {
  constexpr int kStep = 8;
  constexpr double kFarthest_m = 100.0;
  std::vector<double> values;
  for (int row = 0; row < depth.rows; row += kStep) {
    for (int column = 0; column < depth.cols; column += kStep) {
      const float value = depth.at<float>(row, column);
      if (value > 0.0f) values.push_back(value);
    }
  }
  return !values.empty() && percentile(values, 0.5) > kFarthest_m;
}

DepthImage depthOfFloats(const cv::Mat& floats) {
  const cv::Mat depth = withoutInvalid(floats);
  const bool is_in_mm = isInMillimetres(depth);
  return {depth, is_in_mm ? kMillimetre_m : 1.0, is_in_mm};
}

// Negative numbers are no depth.
cv::Mat fromSigned(const cv::Mat& depth) {
  cv::Mat unsigned_depth;
  depth.convertTo(unsigned_depth, CV_16U);
  return unsigned_depth;
}

// The encoding that a format begins with; empty where it names none, as "png" and "compressedDepth".
std::string encodingOf(const std::string& format) {
  const std::string name = lowered(format.substr(0, format.find(';')));
  return contains(name, "compresseddepth") || contains(name, "png") ? "" : name;
}

// Where the image begins: behind the transport's header or, as a plain PNG, at once.
struct Compressed {
  CompressedDepthHeader header{};
  bool has_header = false;
  cv::Mat image;
};

Compressed decompress(const sensor_msgs::CompressedImage& message, const std::string& topic) {
  constexpr size_t kHeader = sizeof(CompressedDepthHeader);
  const unsigned char* data = message.data.data();
  const size_t size = message.data.size();
  Compressed result;
  if (beginsAsPng(data, size)) {
    result.image = decodePng16(data, size, topic);
    return result;
  }
  const bool has_png = size > kHeader && beginsAsPng(data + kHeader, size - kHeader);
  const bool has_rvl = contains(message.format, "rvl");
  check(has_png || has_rvl || contains(message.format, "compressedDepth"),
        topic + ": format '" + message.format +
            "' is no depth; compressedDepth as png or rvl, and png of 16 bits are accepted");
  check(size > kHeader, topic + ": the compressed image is empty");
  std::memcpy(&result.header, data, kHeader);
  result.has_header = true;
  result.image = has_rvl && !has_png ? decodeRvl(data + kHeader, size - kHeader, topic)
                                     : decodePng16(data + kHeader, size - kHeader, topic);
  return result;
}

}  // namespace

DepthImage depthFromImage(const sensor_msgs::Image& message, const std::string& topic) {
  const std::string encoding = lowered(message.encoding);
  if (encoding == "32fc1") return depthOfFloats(pixelsOf(message, CV_32FC1, topic).clone());
  if (encoding == "64fc1") {
    cv::Mat floats;
    pixelsOf(message, CV_64FC1, topic).convertTo(floats, CV_32F);
    return depthOfFloats(floats);
  }
  if (encoding == "16sc1") return {fromSigned(pixelsOf(message, CV_16SC1, topic)), kMillimetre_m};
  check(encoding == "16uc1" || encoding == "mono16" || encoding == "z16",
        topic + ": encoding '" + message.encoding + "' is no depth; 16UC1, mono16 and 32FC1 are accepted");
  return {pixelsOf(message, CV_16UC1, topic), kMillimetre_m};
}

DepthImage depthFromCompressed(const sensor_msgs::CompressedImage& message, const std::string& topic) {
  const Compressed compressed = decompress(message, topic);
  const std::string encoding = encodingOf(message.format);
  const bool is_inverse =
      encoding == "32fc1" || (encoding.empty() && compressed.has_header && compressed.header.quant_a > 0.0f);
  const bool is_known = encoding.empty() || encoding == "16uc1" || encoding == "mono16";
  check(is_known || (is_inverse && compressed.has_header),
        topic + ": format '" + message.format + "' is no depth; 16UC1 and 32FC1 are accepted");
  if (is_inverse) return {depthFromInverse(compressed.image, compressed.header), 1.0};
  return {compressed.image, kMillimetre_m};
}

}  // namespace depth_fusion
