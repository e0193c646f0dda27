#include "ros/conversions/image_conversions.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "common/io/image_file.h"
#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr double kMillimetre_m = 0.001;
constexpr int kAsItIs = -1;

struct ColorEncoding {
  const char* name;
  int type;
  int conversion;  // cv::cvtColor's code, or kAsItIs
};

constexpr ColorEncoding kColorEncodings[] = {{"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
                                             {"bgr8", CV_8UC3, kAsItIs},
                                             {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
                                             {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
                                             {"mono8", CV_8UC1, kAsItIs}};

// The header that compressed_depth_image_transport puts before the PNG.
struct CompressedDepthHeader {
  int32_t format;
  float quant_a;
  float quant_b;
};
static_assert(sizeof(CompressedDepthHeader) == 12, "as on the wire");

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

// Shares the message's memory if its byte order and step are those of an image here, and copies otherwise.
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

bool isRectified(const sensor_msgs::CameraInfo& info, const std::string& image_topic) {
  return contains(image_topic, "rect") && info.P[0] > 0.0;
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

cv::Mat colorFromImage(const sensor_msgs::Image& message, const std::string& topic) {
  const auto encoding = std::find_if(std::begin(kColorEncodings), std::end(kColorEncodings),
                                     [&](const ColorEncoding& e) { return message.encoding == e.name; });
  check(encoding != std::end(kColorEncodings),
        topic + ": encoding '" + message.encoding +
            "' is not accepted for colour; rgb8, bgr8, rgba8, bgra8 and mono8 are");
  cv::Mat image = pixelsOf(message, encoding->type, topic);
  if (encoding->conversion == kAsItIs) return image;
  cv::Mat converted;
  cv::cvtColor(image, converted, encoding->conversion);
  return converted;
}

CameraIntrinsics cameraFromInfo(const sensor_msgs::CameraInfo& info, const std::string& image_topic) {
  const int width = static_cast<int>(info.width);
  const int height = static_cast<int>(info.height);
  if (isRectified(info, image_topic)) return {width, height, info.P[0], info.P[5], info.P[2], info.P[6]};
  return {width, height, info.K[0], info.K[4], info.K[2], info.K[5]};
}

LensDistortion distortionFromInfo(const sensor_msgs::CameraInfo& info, const std::string& image_topic) {
  if (isRectified(info, image_topic) || !distorts(info.D)) return {};
  const std::string& model = info.distortion_model;  // empty in old bags
  check(model == "plumb_bob" || model == "rational_polynomial" || model.empty(),
        image_topic + ": the distortion model '" + model +
            "' of its camera_info is not known; plumb_bob and rational_polynomial are, others must be "
            "rectified before");
  checkDistortion(info.D);
  return info.D;
}

cv::Mat colorFromCompressed(const sensor_msgs::CompressedImage& message, const std::string& topic) {
  return decodeColorImage(message.data.data(), message.data.size(), topic);
}

}  // namespace depth_fusion
