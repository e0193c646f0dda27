#include "ros/conversions/image_conversions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "support/bag_messages.h"
#include "support/expect_error.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

const char kTopic[] = "/camera/image";

cv::Mat withSwappedBytes(const cv::Mat& image) {
  cv::Mat swapped = image.clone();
  const size_t size = image.elemSize1();
  for (size_t i = 0; i < image.total() * image.elemSize(); ++i) {
    swapped.data[i - i % size + (size - 1 - i % size)] = image.data[i];
  }
  return swapped;
}

cv::Mat metresOf(const cv::Mat& millimetres) {
  cv::Mat metres;
  millimetres.convertTo(metres, CV_32F, 0.001);
  return metres;
}

TEST(ImageConversions, reads_depth_of_16_bits) {
  for (const char* encoding : {"16UC1", "mono16"}) {
    for (const int padding : {0, 3, 8}) {
      const sensor_msgs::Image message = imageMessage(randomDepth(1), encoding, padding);
      const DepthImage depth = depthFromImage(message, kTopic);
      EXPECT_TRUE(sameImage(depth.image, randomDepth(1))) << encoding << ", padding " << padding;
      EXPECT_DOUBLE_EQ(depth.unit_m, 0.001);
      // No copy, where the rows begin at whole pixels.
      EXPECT_EQ(depth.image.data == message.data.data(), padding % 2 == 0);
    }
  }
}

TEST(ImageConversions, reads_depth_in_metres) {
  const DepthImage depth = depthFromImage(imageMessage(metresOf(randomDepth(1)), "32FC1", 5), kTopic);
  EXPECT_TRUE(sameImage(depth.image, metresOf(randomDepth(1))));
  EXPECT_DOUBLE_EQ(depth.unit_m, 1.0);
}

TEST(ImageConversions, makes_every_invalid_distance_nan) {
  cv::Mat metres = metresOf(randomDepth(1));
  const float infinity = std::numeric_limits<float>::infinity();
  metres.at<float>(1, 0) = infinity;
  metres.at<float>(1, 1) = -infinity;
  metres.at<float>(1, 2) = -1.0f;
  metres.at<float>(1, 3) = std::numeric_limits<float>::quiet_NaN();
  metres.at<float>(1, 4) = 2.5f;
  const cv::Mat depth = depthFromImage(imageMessage(metres, "32FC1"), kTopic).image;
  for (int column = 0; column < 4; ++column) EXPECT_TRUE(std::isnan(depth.at<float>(1, column))) << column;
  EXPECT_EQ(depth.at<float>(1, 4), 2.5f);
}

TEST(ImageConversions, reads_depth_by_other_names) {
  const cv::Mat depth = randomDepth(1) / 2;  // what fits into 15 bits
  for (const char* encoding : {"16uc1", "MONO16", "Z16", "16SC1"}) {
    const sensor_msgs::Image message = imageMessage(depth, encoding, 6);
    const DepthImage read = depthFromImage(message, kTopic);
    EXPECT_TRUE(sameImage(read.image, depth)) << encoding;
    EXPECT_EQ(read.unit_m, 0.001);
  }
  const cv::Mat below_zero(2, 3, CV_16SC1, cv::Scalar(-1));
  EXPECT_EQ(cv::countNonZero(depthFromImage(imageMessage(below_zero, "16SC1"), kTopic).image), 0);
  cv::Mat doubles;
  metresOf(depth).convertTo(doubles, CV_64F);
  EXPECT_TRUE(sameImage(depthFromImage(imageMessage(doubles, "64FC1"), kTopic).image, metresOf(depth)));
}

TEST(ImageConversions, floats_that_are_too_large_for_metres_are_millimetres) {
  cv::Mat millimetres;
  randomDepth(1).convertTo(millimetres, CV_32F);
  const DepthImage read = depthFromImage(imageMessage(millimetres, "32FC1"), kTopic);
  EXPECT_TRUE(read.is_in_unusual_unit);
  EXPECT_EQ(read.unit_m, 0.001);
  const DepthImage usual = depthFromImage(imageMessage(metresOf(randomDepth(1)), "32FC1"), kTopic);
  EXPECT_FALSE(usual.is_in_unusual_unit);
  EXPECT_EQ(usual.unit_m, 1.0);
  const cv::Mat none = cv::Mat::zeros(8, 12, CV_32FC1);
  EXPECT_FALSE(depthFromImage(imageMessage(none, "32FC1"), kTopic).is_in_unusual_unit);
}

TEST(ImageConversions, reads_big_endian_depth) {
  sensor_msgs::Image message = imageMessage(withSwappedBytes(randomDepth(1)), "16UC1", 4);
  message.is_bigendian = 1;
  EXPECT_TRUE(sameImage(depthFromImage(message, kTopic).image, randomDepth(1)));
  message = imageMessage(withSwappedBytes(metresOf(randomDepth(1))), "32FC1");
  message.is_bigendian = 1;
  EXPECT_TRUE(sameImage(depthFromImage(message, kTopic).image, metresOf(randomDepth(1))));
}

TEST(ImageConversions, reads_every_encoding_of_colour) {
  const cv::Mat bgr = randomColor(1);
  const auto converted = [&](int code) {
    cv::Mat image;
    cv::cvtColor(bgr, image, code);
    return image;
  };
  EXPECT_TRUE(sameImage(colorFromImage(imageMessage(bgr, "bgr8", 2), kTopic), bgr));
  EXPECT_TRUE(sameImage(colorFromImage(imageMessage(converted(cv::COLOR_BGR2RGB), "rgb8", 1), kTopic), bgr));
  EXPECT_TRUE(sameImage(colorFromImage(imageMessage(converted(cv::COLOR_BGR2RGBA), "rgba8"), kTopic), bgr));
  EXPECT_TRUE(sameImage(colorFromImage(imageMessage(converted(cv::COLOR_BGR2BGRA), "bgra8"), kTopic), bgr));
  const cv::Mat gray = randomColor(1, CV_8UC1);
  EXPECT_TRUE(sameImage(colorFromImage(imageMessage(gray, "mono8", 7), kTopic), gray));
}

TEST(ImageConversions, reads_compressed_colour) {
  const cv::Mat color = randomColor(1);
  EXPECT_TRUE(sameImage(colorFromCompressed(compressedMessage(color, ".png", "png"), kTopic), color));
  const cv::Mat smooth(64, 64, CV_8UC3, cv::Scalar(200, 100, 50));
  const cv::Mat read =
      colorFromCompressed(compressedMessage(smooth, ".jpg", "bgr8; jpeg compressed bgr8"), kTopic);
  ASSERT_EQ(read.type(), CV_8UC3);
  EXPECT_LE(cv::norm(read, smooth, cv::NORM_INF), 3.0);
}

TEST(ImageConversions, reads_compressed_depth_of_16_bits) {
  for (const char* format :
       {"16UC1; compressedDepth", "16UC1; compressedDepth png", "mono16; compressedDepth"}) {
    const DepthImage depth = depthFromCompressed(compressedDepthMessage(randomDepth(1), format), kTopic);
    EXPECT_TRUE(sameImage(depth.image, randomDepth(1))) << format;
    EXPECT_DOUBLE_EQ(depth.unit_m, 0.001);
  }
  const auto plain_png = compressedMessage(randomDepth(1), ".png", "16UC1; png compressed ");
  EXPECT_TRUE(sameImage(depthFromCompressed(plain_png, kTopic).image, randomDepth(1)));
}

// The data tell what they are.
TEST(ImageConversions, reads_compressed_depth_whatever_the_format_says) {
  for (const char* format : {"compressedDepth", "png", "", "16UC1", "16UC1; compressedDepth rvl"}) {
    const DepthImage depth = depthFromCompressed(compressedDepthMessage(randomDepth(1), format), kTopic);
    EXPECT_TRUE(sameImage(depth.image, randomDepth(1))) << format;
    EXPECT_DOUBLE_EQ(depth.unit_m, 0.001);
  }
  const auto without_header = compressedMessage(randomDepth(1), ".png", "16UC1; compressedDepth");
  EXPECT_TRUE(sameImage(depthFromCompressed(without_header, kTopic).image, randomDepth(1)));
}

// Two zeros, and three others, whose differences 5, 1, -2 stand as 10, 2, 3; 10 takes two nibbles, of which
// the first has 8 for "more follows".
TEST(ImageConversions, reads_depth_that_rvl_compressed) {
  sensor_msgs::CompressedImage message;
  message.format = "16UC1; compressedDepth rvl";
  message.data.assign(12, 0);
  const uint32_t words[] = {3, 2, 0x23a12310u, 0u};  // 3x2 pixels; nibbles 2 3 a1 2 3 1 0
  const auto* bytes = reinterpret_cast<const unsigned char*>(words);
  message.data.insert(message.data.end(), bytes, bytes + sizeof(words));
  const DepthImage depth = depthFromCompressed(message, kTopic);
  EXPECT_TRUE(sameImage(depth.image, (cv::Mat_<uint16_t>(2, 3) << 0, 0, 5, 6, 4, 0)));
  EXPECT_EQ(depth.unit_m, 0.001);

  message.data.resize(22);
  expectError([&] { depthFromCompressed(message, kTopic); }, {kTopic, "truncated"});
  message.data[12] = message.data[13] = message.data[14] = message.data[15] = 0xff;
  expectError([&] { depthFromCompressed(message, kTopic); }, {kTopic, "corrupt"});
  message.data.resize(20);
  expectError([&] { depthFromCompressed(message, kTopic); }, {kTopic, "empty"});
}

// The transport quantises 1/depth: with depth_max 10 m and quantisation 100, A = 100 * 101 and B = 1 - A
// / 10.
TEST(ImageConversions, reads_compressed_depth_in_metres) {
  const float quant_a = 10100.0f;
  const float quant_b = 1.0f - quant_a / 10.0f;
  cv::Mat metres(kTestHeight, kTestWidth, CV_32FC1);
  cv::RNG(7).fill(metres, cv::RNG::UNIFORM, 0.5f, 5.0f);
  cv::Mat quantised(metres.size(), CV_16UC1);
  for (int i = 0; i < static_cast<int>(metres.total()); ++i) {
    quantised.at<uint16_t>(i) = static_cast<uint16_t>(quant_a / metres.at<float>(i) + quant_b);
  }
  quantised.at<uint16_t>(0) = 0;
  const DepthImage depth = depthFromCompressed(
      compressedDepthMessage(quantised, "32FC1; compressedDepth png", quant_a, quant_b), kTopic);
  EXPECT_DOUBLE_EQ(depth.unit_m, 1.0);
  ASSERT_EQ(depth.image.type(), CV_32FC1);
  EXPECT_TRUE(std::isnan(depth.image.at<float>(0)));
  for (int i = 1; i < static_cast<int>(metres.total()); ++i) {
    const float z_m = metres.at<float>(i);
    EXPECT_NEAR(depth.image.at<float>(i), z_m, 1.1f * z_m * z_m / quant_a) << i;
  }
}

TEST(ImageConversions, names_topic_and_what_is_accepted) {
  const cv::Mat gray = randomColor(1, CV_8UC1);
  expectError([&] { depthFromImage(imageMessage(gray, "mono8"), kTopic); },
              {kTopic, "mono8", "16UC1", "32FC1"});
  expectError([&] { colorFromImage(imageMessage(gray, "nv21"), kTopic); }, {kTopic, "nv21", "bgr8"});
  const auto expectBadDepth = [](const sensor_msgs::CompressedImage& message, const std::string& word) {
    expectError([&] { depthFromCompressed(message, kTopic); }, {kTopic, word});
  };
  expectBadDepth(compressedDepthMessage(randomDepth(1), "8UC1; compressedDepth"), "8UC1");
  expectBadDepth(compressedDepthMessage(gray, "16UC1; compressedDepth"), "16 bits");
  expectBadDepth(compressedMessage(gray, ".jpg", "jpeg"), "jpeg");
  expectBadDepth(sensor_msgs::CompressedImage(), "format ''");
}

TEST(ImageConversions, notices_images_that_are_cut_short) {
  sensor_msgs::Image message = imageMessage(randomDepth(1), "16UC1");
  message.data.pop_back();
  expectError([&] { depthFromImage(message, kTopic); }, {kTopic, "too few", "12x8"});
  message = imageMessage(randomDepth(1), "16UC1");
  message.step = 2;
  expectError([&] { depthFromImage(message, kTopic); }, {kTopic, "step of 2"});
  message = imageMessage(randomDepth(1), "16UC1");
  message.height = 0;
  expectError([&] { depthFromImage(message, kTopic); }, {kTopic, "empty"});
  sensor_msgs::CompressedImage compressed = compressedDepthMessage(randomDepth(1), "16UC1; compressedDepth");
  compressed.data.resize(compressed.data.size() - 12);
  expectError([&] { depthFromCompressed(compressed, kTopic); }, {kTopic, "truncated"});
  compressed.data.resize(12);
  expectError([&] { depthFromCompressed(compressed, kTopic); }, {kTopic, "empty"});
  compressed = compressedMessage(randomColor(1), ".jpg", "jpeg");
  compressed.data.resize(compressed.data.size() - 2);
  expectError([&] { colorFromCompressed(compressed, kTopic); }, {kTopic, "truncated"});
}

}  // namespace
}  // namespace depth_fusion
