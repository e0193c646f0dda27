// Encodings of colour: each gives the same picture.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "ros/conversions/image_conversions.h"
#include "support/bag_messages.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

const cv::Scalar kBgr(40, 90, 200);

cv::Mat evenColor() { return cv::Mat(8, 12, CV_8UC3, kBgr); }

cv::Mat converted(int code, const cv::Mat& image = evenColor()) {
  cv::Mat result;
  cv::cvtColor(image, result, code);
  return result;
}

cv::Mat in16Bits(const cv::Mat& image) {
  cv::Mat result;
  image.convertTo(result, CV_16U, 257.0);
  return result;
}

// What the sensor measures through its filters, which are named from the left top as ROS does: "rggb".
cv::Mat mosaic(const std::string& pattern) {
  cv::Mat image(8, 12, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const char filter = pattern[static_cast<size_t>(2 * (y % 2) + x % 2)];
      image.at<uint8_t>(y, x) = static_cast<uint8_t>(kBgr[filter == 'b' ? 0 : filter == 'g' ? 1 : 2]);
    }
  }
  return image;
}

void expectEvenColor(const cv::Mat& image, const std::string& encoding, double tolerance = 0.0) {
  ASSERT_EQ(image.type(), CV_8UC3) << encoding;
  EXPECT_LE(cv::norm(image, evenColor(), cv::NORM_INF), tolerance) << encoding;
}

TEST(ColorConversions, read_colour_of_8_and_16_bits) {
  const std::pair<const char*, cv::Mat> encodings[] = {{"8UC3", evenColor()},
                                                       {"RGB8", converted(cv::COLOR_BGR2RGB)},
                                                       {"8UC4", converted(cv::COLOR_BGR2BGRA)},
                                                       {"bgr16", in16Bits(evenColor())},
                                                       {"rgb16", in16Bits(converted(cv::COLOR_BGR2RGB))},
                                                       {"rgba16", in16Bits(converted(cv::COLOR_BGR2RGBA))},
                                                       {"bgra16", in16Bits(converted(cv::COLOR_BGR2BGRA))}};
  for (const auto& [encoding, pixels] : encodings)
    expectEvenColor(colorFromImage(imageMessage(pixels, encoding, 6), "/rgb"), encoding);
}

TEST(ColorConversions, read_gray) {
  const cv::Mat gray = randomColor(1, CV_8UC1);
  EXPECT_TRUE(sameImage(colorFromImage(imageMessage(gray, "8UC1", 3), "/rgb"), gray));
  EXPECT_TRUE(sameImage(colorFromImage(imageMessage(in16Bits(gray), "mono16"), "/rgb"), gray));
}

TEST(ColorConversions, read_bayer_patterns) {
  for (const std::string pattern : {"rggb", "bggr", "gbrg", "grbg"}) {
    const cv::Mat image = mosaic(pattern);
    expectEvenColor(colorFromImage(imageMessage(image, "bayer_" + pattern + "8", 5), "/rgb"), pattern);
    expectEvenColor(colorFromImage(imageMessage(in16Bits(image), "bayer_" + pattern + "16"), "/rgb"),
                    pattern);
    expectEvenColor(colorFromCompressed(
                        compressedMessage(image, ".png", "bayer_" + pattern + "8; png compressed "), "/rgb"),
                    pattern);
  }
}

// U Y V Y, or Y U Y V, for each two pixels.
TEST(ColorConversions, read_yuv422) {
  const cv::Vec3f bt601(16.0f + 0.257f * 200 + 0.504f * 90 + 0.098f * 40,
                        128.0f - 0.148f * 200 - 0.291f * 90 + 0.439f * 40,
                        128.0f + 0.439f * 200 - 0.368f * 90 - 0.071f * 40);
  cv::Mat uyvy(8, 12, CV_8UC2), yuyv(8, 12, CV_8UC2);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 12; ++x) {
      const auto luma = cv::saturate_cast<uint8_t>(bt601[0]);
      const auto chroma = cv::saturate_cast<uint8_t>(bt601[1 + x % 2]);
      uyvy.at<cv::Vec2b>(y, x) = {chroma, luma};
      yuyv.at<cv::Vec2b>(y, x) = {luma, chroma};
    }
  }
  constexpr double kRounding = 3.0;
  for (const char* encoding : {"yuv422", "UYVY"})
    expectEvenColor(colorFromImage(imageMessage(uyvy, encoding), "/rgb"), encoding, kRounding);
  for (const char* encoding : {"yuv422_yuy2", "YUYV"})
    expectEvenColor(colorFromImage(imageMessage(yuyv, encoding), "/rgb"), encoding, kRounding);
}

}  // namespace
}  // namespace depth_fusion
