#include <gtest/gtest.h>

#include "color_fusion/color_fusion_kernels.h"
#include "depth_fusion/compute/device_image.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kDepthCamera{64, 48, 50.0, 50.0, 31.5, 23.5};

TEST(ColorKernels, MovedDepthCoversWhatTheColorCameraSeesAndNoMore) {
  // A square at 2 m before a wall that is not measured, and 0.2 m off in the colour camera, which is twice as
  // fine.
  constexpr CameraIntrinsics color_camera{128, 96, 100.0, 100.0, 63.0, 47.0};
  cv::Mat depth = cv::Mat::zeros(kDepthCamera.height, kDepthCamera.width, CV_32FC1);
  depth(cv::Rect(20, 10, 16, 12)).setTo(2.0);
  DepthLevel level{kDepthCamera, zeroImage(compute(), kDepthCamera), zeroImage(compute(), kDepthCamera)};
  writeImage(level.depth, kDepthCamera, depth);
  DeviceBuffer depth_C = zeroImage(compute(), color_camera);
  Pose T_C_D = Pose::Identity();
  T_C_D.translation() = Eigen::Vector3d(0.2, -0.1, 0.0);
  ColorFusion::Kernels kernels(compute(), MapParameters());
  kernels.moveDepth(level, depth_C, color_camera, T_C_D);

  // Pixel u of D falls on 2 u + 10 of C, v on 2 v - 5, and covers 3 x 3 pixels there.
  cv::Mat expected = cv::Mat::zeros(color_camera.height, color_camera.width, CV_32FC1);
  expected(cv::Rect(2 * 20 + 10 - 1, 2 * 10 - 5 - 1, 2 * 15 + 3, 2 * 11 + 3)).setTo(2.0);
  EXPECT_EQ(cv::norm(readImage(depth_C, color_camera), expected, cv::NORM_INF), 0.0);
}

// A wall at 1 m that ends before one at 2 m, a pixel without depth, and one that is overexposed in red.
class RatedPixels : public testing::Test {
 protected:
  static constexpr CameraIntrinsics kCamera = kDepthCamera;
  static constexpr int kEdge = 40;  // the first column of the far wall
  static constexpr uint32_t kGrey = 0x646464u, kRed = 0xff6464u;

  RatedPixels() {
    cv::Mat depth(kCamera.height, kCamera.width, CV_32FC1, cv::Scalar(1.0));
    depth.colRange(kEdge, kCamera.width).setTo(2.0);
    depth.at<float>(12, 16) = 0.0f;
    cv::Mat image(kCamera.height, kCamera.width, CV_32SC1, cv::Scalar(kGrey));
    image.at<int>(36, 16) = kRed;
    DeviceBuffer depth_C = zeroImage(compute(), kCamera), pixels = zeroImage(compute(), kCamera);
    writeImage(depth_C, kCamera, depth);
    writeImage(pixels, kCamera, cv::Mat(image.size(), CV_32FC1, image.data));
    ColorFusion::Kernels(compute(), MapParameters()).ratePixels(pixels, depth_C, kCamera, 0.03f);
    rated_ = readImage(pixels, kCamera);
  }

  uint32_t word(int x, int y) const { return rated_.ptr<uint32_t>(y)[x]; }
  uint32_t quality(int x, int y) const { return word(x, y) >> 24; }

  cv::Mat rated_;
};

TEST_F(RatedPixels, AreTrustedLessTheNearerADepthEdgeIs) {
  for (const int y : {0, 24, kCamera.height - 1}) {
    for (int x = 24; x < 56; ++x) {
      const int to_other_side = x < kEdge ? kEdge - x : x - kEdge + 1;
      const uint32_t expected = to_other_side <= 2 ? 4 : to_other_side <= 4 ? 40 : 255;
      EXPECT_EQ(quality(x, y), expected) << x << " " << y;
    }
  }
}

TEST_F(RatedPixels, AreTrustedLeastWithoutDepth) {
  EXPECT_EQ(quality(16, 12), 2u);
  EXPECT_EQ(quality(14, 12), 4u) << "beside it";
}

TEST_F(RatedPixels, AreTrustedLittleWhereOverexposed) {
  EXPECT_EQ(quality(16, 36), 16u);
  EXPECT_EQ(quality(17, 36), 255u);
}

TEST_F(RatedPixels, KeepTheirColor) {
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x)
      ASSERT_EQ(word(x, y) & 0xffffffu, x == 16 && y == 36 ? kRed : kGrey) << x << " " << y;
  }
}

}  // namespace
}  // namespace depth_fusion
