#include "depth_fusion/compute/device_image.h"

#include <gtest/gtest.h>

#include "geometry/kernel_args.h"
#include "support/expect_error.h"
#include "support/test_compute.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

CameraIntrinsics cameraOfSize(int width, int height) { return {width, height, 100.0, 100.0, 5.0, 5.0}; }

cv::Mat randomImage(const CameraIntrinsics& camera) {
  cv::Mat image(camera.height, camera.width, CV_32FC1);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 1.0, 2.0);
  return image;
}

TEST(DeviceImage, ReadsBackWhatWasWritten) {
  for (const auto& [width, height] : {std::pair{1, 1}, {16, 3}, {17, 5}, {100, 75}, {640, 480}}) {
    const CameraIntrinsics camera = cameraOfSize(width, height);
    const cv::Mat image = randomImage(camera);
    DeviceBuffer device = zeroImage(compute(), camera);
    writeImage(device, camera, image);
    EXPECT_TRUE(sameImage(readImage(device, camera), image)) << width << "x" << height;
  }
}

TEST(DeviceImage, HoldsZerosBesideThePixels) {
  for (const auto& [width, height] : {std::pair{16, 3}, {17, 5}, {100, 75}}) {
    const CameraIntrinsics camera = cameraOfSize(width, height);
    DeviceBuffer device = zeroImage(compute(), camera);
    ASSERT_EQ(cv::countNonZero(readImage(device, camera)), 0);
    writeImage(device, camera, randomImage(camera));
    const std::vector<float> elements = device.read<float>(device.bytes() / sizeof(float));
    const auto nonzero = elements.size() - std::count(elements.begin(), elements.end(), 0.0f);
    EXPECT_EQ(nonzero,
              static_cast<size_t>(width) * height);  // random pixels are never 0, so that all the rest is
    const CameraArgs args = toArgs(camera);
    EXPECT_GE(args.pitch, width + IMAGE_GUARD);
    for (int i = 0; i < IMAGE_GUARD; ++i) {
      EXPECT_EQ(elements[i], 0.0f);
      EXPECT_EQ(elements[imageElements(camera) - 1 - i], 0.0f);
    }
  }
}

TEST(DeviceImage, PixelsLieWhereKernelsLookForThem) {
  const CameraIntrinsics camera = cameraOfSize(20, 6);
  DeviceBuffer device = zeroImage(compute(), camera);
  const cv::Mat image = randomImage(camera);
  writeImage(device, camera, image);
  const std::vector<float> elements = device.read<float>(device.bytes() / sizeof(float));
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const size_t pixel = IMAGE_GUARD + y * toArgs(camera).pitch + x;
      ASSERT_EQ(elements[pixel], image.at<float>(y, x));
    }
  }
}

TEST(DeviceImage, RefusesOtherTypesAndSizes) {
  const CameraIntrinsics camera = cameraOfSize(20, 6);
  DeviceBuffer device = zeroImage(compute(), camera);
  expectError([&] { writeImage(device, camera, cv::Mat::zeros(6, 20, CV_16UC1)); }, {"writeImage", "float"});
  expectError([&] { writeImage(device, camera, cv::Mat::zeros(6, 21, CV_32FC1)); }, {"writeImage", "size"});
}

}  // namespace
}  // namespace depth_fusion
