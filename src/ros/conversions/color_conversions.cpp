#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "common/io/image_file.h"
#include "common/lowered.h"
#include "depth_fusion/common/error.h"
#include "ros/conversions/image_conversions.h"
#include "ros/conversions/message_pixels.h"

namespace depth_fusion {
namespace {

constexpr int kAsItIs = -1;

struct ColorEncoding {
  const char* name;
  int type;        // of the message's pixels
  int conversion;  // cv::cvtColor's code for 8 bits, or kAsItIs
};

// cv_bridge writes images of no given meaning as 8UC1, 8UC3 and the like; they are OpenCV's, BGR. ROS names a
// Bayer pattern by its first row and column, OpenCV by its second.
constexpr ColorEncoding kColorEncodings[] = {{"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
                                             {"bgr8", CV_8UC3, kAsItIs},
                                             {"8uc3", CV_8UC3, kAsItIs},
                                             {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
                                             {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
                                             {"8uc4", CV_8UC4, cv::COLOR_BGRA2BGR},
                                             {"mono8", CV_8UC1, kAsItIs},
                                             {"8uc1", CV_8UC1, kAsItIs},
                                             {"rgb16", CV_16UC3, cv::COLOR_RGB2BGR},
                                             {"bgr16", CV_16UC3, kAsItIs},
                                             {"16uc3", CV_16UC3, kAsItIs},
                                             {"rgba16", CV_16UC4, cv::COLOR_RGBA2BGR},
                                             {"bgra16", CV_16UC4, cv::COLOR_BGRA2BGR},
                                             {"16uc4", CV_16UC4, cv::COLOR_BGRA2BGR},
                                             {"mono16", CV_16UC1, kAsItIs},
                                             {"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
                                             {"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
                                             {"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
                                             {"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
                                             {"bayer_rggb16", CV_16UC1, cv::COLOR_BayerBG2BGR},
                                             {"bayer_bggr16", CV_16UC1, cv::COLOR_BayerRG2BGR},
                                             {"bayer_gbrg16", CV_16UC1, cv::COLOR_BayerGR2BGR},
                                             {"bayer_grbg16", CV_16UC1, cv::COLOR_BayerGB2BGR},
                                             {"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
                                             {"uyvy", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
                                             {"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
                                             {"yuyv", CV_8UC2, cv::COLOR_YUV2BGR_YUY2}};

const ColorEncoding* findEncoding(const std::string& any_case) {
  const std::string name = lowered(any_case);
  const auto found = std::find_if(std::begin(kColorEncodings), std::end(kColorEncodings),
                                  [&](const ColorEncoding& e) { return name == e.name; });
  return found == std::end(kColorEncodings) ? nullptr : found;
}

// BGR or gray of 8 bits.
cv::Mat convert(const cv::Mat& pixels, const ColorEncoding& encoding) {
  constexpr double kTo8Bits = 255.0 / 65535.0;
  cv::Mat image = pixels;
  if (pixels.depth() == CV_16U) pixels.convertTo(image, CV_8U, kTo8Bits);
  if (encoding.conversion == kAsItIs) return image;
  cv::Mat converted;
  cv::cvtColor(image, converted, encoding.conversion);
  return converted;
}

}  // namespace

cv::Mat colorFromImage(const sensor_msgs::Image& message, const std::string& topic) {
  const ColorEncoding* encoding = findEncoding(message.encoding);
  check(encoding != nullptr,
        topic + ": encoding '" + message.encoding +
            "' is not accepted for colour; rgb, bgr, rgba and bgra (as bgr8), mono, bayer_* of 8 "
            "and 16 bits, yuv422 and yuv422_yuy2 are");
  return convert(pixelsOf(message, encoding->type, topic), *encoding);
}

// The transport compresses Bayer patterns as if they were gray.
cv::Mat colorFromCompressed(const sensor_msgs::CompressedImage& message, const std::string& topic) {
  const cv::Mat image = decodeColorImage(message.data.data(), message.data.size(), topic);
  const std::string name = message.format.substr(0, message.format.find(';'));
  const ColorEncoding* encoding = name.rfind("bayer_", 0) == 0 ? findEncoding(name) : nullptr;
  return encoding != nullptr && image.type() == CV_8UC1 ? convert(image, *encoding) : image;
}

}  // namespace depth_fusion
