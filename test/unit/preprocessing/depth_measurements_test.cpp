#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "support/busy_depth.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

// The device's measurements, unpacked, against the reference's; depth differs by half a step, the others by
// half a code.
void expectMeasurements(const DepthFrame& frame, const cv::Mat& weights) {
  const DepthLevel& level = frame.levels[0];
  const cv::Mat depth = readImage(level.depth, level.camera);
  const cv::Mat normals = readNormals(level.normals, level.camera);
  cv::Mat expected = reference::measurements(depth, normals, weights, level.camera);
  const cv::Mat words = readImage(frame.measurements, level.camera);
  reference::forEachPixel<cv::Vec3f>(expected, [&](int x, int y, const cv::Vec3f& pixel) {
    uint32_t word = 0;
    std::memcpy(&word, words.ptr<float>(y, x), sizeof(word));
    const cv::Vec3f measured = reference::unpackedMeasurement(word, frame.depth_step_m);
    ASSERT_NEAR(measured[0], pixel[0], 0.51f * frame.depth_step_m) << x << " " << y;
    ASSERT_NEAR(measured[1], pixel[1], 0.52f / MEASUREMENT_MAX) << x << " " << y;
    ASSERT_NEAR(measured[2], std::max(pixel[2], pixel[0] == 0.0f ? 0.0f : 1.0f / MEASUREMENT_MAX),
                0.52f / MEASUREMENT_MAX)
        << x << " " << y;
  });
}

TEST(DepthMeasurements, MeasurementsEqualTheReference) {
  for (const auto& [width, height] : {std::pair{100, 75}, {33, 31}}) {
    const CameraIntrinsics camera = cameraOfSize(width, height);
    DepthPreprocessor preprocessor(compute(), {}, camera);
    const DepthFrame& frame = preprocessor.process(frameOf(busyDepth(camera)));
    expectMeasurements(frame, cv::Mat());
    EXPECT_EQ(nonzeroPadding(frame.measurements, camera), 0);
  }
}

TEST(DepthMeasurements, PixelsWithoutAProperWeightAreNotMeasured) {
  const CameraIntrinsics camera = cameraOfSize(100, 75);
  DepthPreprocessor preprocessor(compute(), {}, camera);
  RgbdFrame input = frameOf(busyDepth(camera));
  input.weights = cv::Mat(camera.height, camera.width, CV_32FC1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> values = {1.0f, 0.25f, 1e-8f, 0.0f, -0.5f, nan, infinity, -infinity, 1.5f};
  reference::forEachPixel<float>(input.weights, [&](int x, int, float& weight) { weight = values[x % 9]; });
  expectMeasurements(preprocessor.process(input), input.weights);
  input.weights = cv::Mat();
  expectMeasurements(preprocessor.process(input), cv::Mat());
}

}  // namespace
}  // namespace depth_fusion
