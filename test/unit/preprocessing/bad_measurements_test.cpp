// What is no number never reaches the map.
#include <gtest/gtest.h>

#include <limits>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "support/expect_error.h"
#include "support/fusion_views.h"

namespace depth_fusion {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

RgbdFrame frameWith(const cv::Mat& depth, const cv::Mat& weights) {
  RgbdFrame frame;
  frame.intrinsics = kCamera;
  frame.depth = depth;
  frame.weights = weights;
  return frame;
}

// Every 7th pixel has the next of the values.
cv::Mat sprinkled(const cv::Mat& image, const std::vector<float>& values) {
  cv::Mat result = image.clone();
  reference::forEachPixel<float>(result, [&](int x, int y, float& pixel) {
    const int number = y * image.cols + x;
    if (number % 7 == 0) pixel = values[number / 7 % values.size()];
  });
  return result;
}

MapContent fused(const std::string& rule, const RgbdFrame& frame) {
  PipelineParameters parameters;
  parameters.map = mapParameters();
  parameters.tsdf_fusion.rule = rule;
  parameters.texture_odometry.enabled = false;
  ReconstructionPipeline pipeline(compute(), parameters, kCamera);
  for (int i = 0; i < 5; ++i) pipeline.processFrame(frame, somePose(0.1 * i));
  return readMap(pipeline.map());
}

class BadMeasurements : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Rules, BadMeasurements, testing::Values("average", "weighted", "kalman"));

TEST_P(BadMeasurements, in_depth_are_as_none) {
  const cv::Mat depth = bumpyDepth(1.5);
  const MapContent expected = fused(GetParam(), frameWith(sprinkled(depth, {0.0f}), cv::Mat()));
  const cv::Mat bad = sprinkled(depth, {kNan, kInfinity, -kInfinity, -1.0f, 1e30f, -kNan});
  ASSERT_GT(expected.size(), 50u);
  EXPECT_TRUE(fused(GetParam(), frameWith(bad, cv::Mat())) == expected);
}

TEST_P(BadMeasurements, in_weights_are_as_none) {
  const cv::Mat depth = bumpyDepth(1.5);
  const cv::Mat weights(kCamera.height, kCamera.width, CV_32FC1, cv::Scalar(0.5));
  const MapContent expected = fused(GetParam(), frameWith(depth, sprinkled(weights, {0.0f})));
  const cv::Mat bad = sprinkled(weights, {kNan, kInfinity, -kInfinity, -1.0f, 2.0f, -kNan});
  ASSERT_GT(expected.size(), 50u);
  EXPECT_TRUE(fused(GetParam(), frameWith(depth, bad)) == expected);
}

TEST(BadParameters, of_sensor_and_fusion_are_refused) {
  for (const auto& [name, value] : {std::pair("depth_sensor/sigma_base_m", "0"),
                                    {"depth_sensor/sigma_growth_per_m", "-1"},
                                    {"depth_sensor/edge_sigmas", "0.5"},
                                    {"depth_sensor/max_sigma_m", "0"},
                                    {"tsdf_fusion/process_sigma_m", "nan"},
                                    {"tsdf_fusion/process_sigma_m", "-1"},
                                    {"tsdf_fusion/max_weight", "256"},
                                    {"tsdf_fusion/gain_at_1m", "0"},
                                    {"tsdf_fusion/free_space_rate", "1"},
                                    {"tsdf_fusion/rule", "median"}}) {
    PipelineParameters parameters;
    expectError([&] { setParameter(parameters.table(), name, value); }, {name});
  }
}

}  // namespace
}  // namespace depth_fusion
