// What camera_info messages say of images, and what cannot be.
#include "ros/conversions/camera_info.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/expect_error.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

constexpr char kInfo[] = "/camera/depth/camera_info";
constexpr char kRaw[] = "/camera/depth/image_raw";
constexpr char kRectified[] = "/camera/depth/image_rect_raw";
const cv::Size kSensor(640, 480);

// K and P differ by one pixel of focal length.
sensor_msgs::CameraInfo sensorInfo() {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.K = {520.0, 0.0, 320.0, 0.0, 522.0, 240.0, 0.0, 0.0, 1.0};
  info.P = {521.0, 0.0, 320.0, 0.0, 0.0, 523.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

CameraModel read(const sensor_msgs::CameraInfo& info, const std::string& topic = kRaw,
                 cv::Size size = kSensor) {
  return cameraFromInfo(info, kInfo, topic, size);
}

TEST(CameraInfo, projection_counts_for_rectified_images_and_matrix_for_others) {
  expectSameIntrinsics(read(sensorInfo()).intrinsics, {640, 480, 520.0, 522.0, 320.0, 240.0});
  expectSameIntrinsics(read(sensorInfo(), kRectified).intrinsics, {640, 480, 521.0, 523.0, 320.0, 240.0});
  EXPECT_EQ(read(sensorInfo(), "/direct/depth/image").intrinsics.fx, 520.0)
      << "'direct' does not say rectified";
  EXPECT_TRUE(read(sensorInfo()).remark.empty());
}

TEST(CameraInfo, each_counts_where_the_other_is_none) {
  sensor_msgs::CameraInfo info = sensorInfo();
  for (const auto& none : {std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}, std::array<double, 9>{}}) {
    std::copy(none.begin(), none.end(), info.K.begin());
    EXPECT_EQ(read(info).intrinsics.fx, 521.0);
    EXPECT_NE(read(info).remark.find("P is used"), std::string::npos) << read(info).remark;
  }
  info.D = {0.1, 0.0, 0.0, 0.0, 0.0};
  expectError([&] { read(info); }, {kInfo, "not valid", "640x480"});
  info = sensorInfo();
  info.P.assign(0.0);
  EXPECT_EQ(read(info, kRectified).intrinsics.fx, 520.0);
}

TEST(CameraInfo, binning_and_roi_count_where_the_images_show_them) {
  sensor_msgs::CameraInfo info = sensorInfo();
  info.binning_x = info.binning_y = 2;
  expectSameIntrinsics(read(info, kRaw, {320, 240}).intrinsics, {320, 240, 260.0, 261.0, 160.0, 120.0});
  expectSameIntrinsics(read(info).intrinsics, {640, 480, 520.0, 522.0, 320.0, 240.0});
  EXPECT_NE(read(info).remark.find("binning"), std::string::npos);
  info.binning_x = 4;
  expectSameIntrinsics(read(info, kRaw, {160, 240}).intrinsics, {160, 240, 130.0, 261.0, 80.0, 120.0});
  info.binning_x = info.binning_y = 0;
  info.roi.x_offset = 400;
  info.roi.y_offset = 40;
  info.roi.width = 200;
  info.roi.height = 400;
  expectSameIntrinsics(read(info, kRaw, {200, 400}).intrinsics, {200, 400, 520.0, 522.0, -80.0, 200.0});
  info.binning_x = info.binning_y = 2;
  expectSameIntrinsics(read(info, kRectified, {100, 200}).intrinsics, {100, 200, 260.5, 261.5, -40.0, 100.0});
}

TEST(CameraInfo, another_size_is_refused_with_both_named) {
  expectError(
      [] {
        read(sensorInfo(), kRaw, {320, 240});
      },
      {kInfo, "640x480", kRaw, "320x240", "--intrinsics"});
  sensor_msgs::CameraInfo info = sensorInfo();
  info.binning_x = info.binning_y = 2;
  expectError([&] { read(info, kRaw, {160, 120}); }, {"320x240", "640x480", "160x120"});
  info = sensorInfo();
  info.width = info.height = 0;
  expectSameIntrinsics(read(info).intrinsics, {640, 480, 520.0, 522.0, 320.0, 240.0});
}

TEST(CameraInfo, what_no_camera_can_be_is_refused) {
  const auto expectRefused = [](size_t index, double value, const std::string& word) {
    sensor_msgs::CameraInfo info = sensorInfo();
    info.P.assign(0.0);
    info.K[index] = value;
    expectError([&] { read(info); }, {kInfo, "not valid", word, "camera_calibration"});
  };
  expectRefused(0, 0.0, "640x480");
  expectRefused(0, 1.0, "640x480");
  expectRefused(0, -520.0, "640x480");
  expectRefused(4, std::numeric_limits<double>::quiet_NaN(), "no number");
  expectRefused(2, 700.0, "principal point (700, 240)");
  expectRefused(2, 0.0, "principal point");
  expectRefused(5, -3.0, "principal point");
  expectRefused(5, std::numeric_limits<double>::infinity(), "no number");
}

TEST(CameraInfo, lens_models) {
  const auto lensOf = [](const std::string& model, const std::vector<double>& coefficients) {
    sensor_msgs::CameraInfo info = sensorInfo();
    info.distortion_model = model;
    info.D = coefficients;
    return read(info).lens;
  };
  const std::vector<double> fourteen = {0.1, 0.2, 0, 0, 0, 0, 0, 0, 0.01, 0, 0, 0, 0, 0.001};
  EXPECT_EQ(lensOf("plumb_bob", {0.1, 0, 0, 0}), (LensDistortion{0.1, 0, 0, 0}));
  EXPECT_EQ(lensOf("rational_polynomial", fourteen), fourteen);
  EXPECT_TRUE(lensOf("Inverse Brown Conrady", {0, 0, 0, 0, 0}).empty());
  EXPECT_TRUE(lensOf("plumb_bob", {}).empty());
  expectError(
      [&] {
        lensOf("Inverse Brown Conrady", {0.1, 0, 0, 0, 0});
      },
      {kInfo, "Inverse Brown", "rectified"});
  expectError([&] { lensOf("equidistant", {0, 0, 0, 0}); }, {kInfo, "equidistant", "plumb_bob"});
  expectError([&] { lensOf("kannala_brandt4", {0.1, 0, 0, 0}); }, {kInfo, "kannala_brandt4"});
  expectError([&] { lensOf("plumb_bob", {0.1, 0, 0}); }, {kInfo, "4, 5 or 8", "not 3"});
  expectError(
      [&] {
        lensOf("plumb_bob", {std::numeric_limits<double>::quiet_NaN(), 0, 0, 0});
      },
      {kInfo, "no number"});
}

TEST(CameraInfo, what_is_wrong_with_the_colour_camera_is_colours_problem) {
  const CameraModel depth{{640, 480, 520.0, 522.0, 320.0, 240.0}, {0.1, 0.0, 0.0, 0.0}, ""};
  const auto colorOf = [&](const sensor_msgs::CameraInfo* info, cv::Size size = kSensor) {
    return colorCameraFromInfo(info, "/rgb/camera_info", "/rgb/image", size, depth);
  };
  sensor_msgs::CameraInfo info = sensorInfo();
  EXPECT_TRUE(colorOf(nullptr).is_registered);
  EXPECT_EQ(colorOf(nullptr).lens, depth.lens);
  EXPECT_FALSE(colorOf(&info).intrinsics.has_value()) << "it is the depth camera's";
  info.K[0] = 530.0;
  EXPECT_EQ(colorOf(&info).intrinsics->fx, 530.0);
  EXPECT_NE(colorOf(&info, {1280, 960}).problem.find("1280x960"), std::string::npos);
  info.distortion_model = "equidistant";
  EXPECT_NE(colorOf(&info).problem.find("equidistant"), std::string::npos);
  info.K.assign(0.0);
  info.P.assign(0.0);
  EXPECT_TRUE(colorOf(&info).is_registered && colorOf(&info).problem.empty()) << "the driver does not know";
}

}  // namespace
}  // namespace depth_fusion
