// The sensor model is raised to the noise that an image has, and only to noise.
#include "depth_fusion/preprocessing/sensor_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shared/types.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};
constexpr DepthRange kRange{0.3f, 5.0f};

// A floor from 0.6 to 3.5 m with boxes on it, or a wall at 1 m, in 16 bits, with `times` the model's noise.
RgbdFrame frameWithNoise(double times, const DepthSensorParameters& model, bool wall = false) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  RgbdFrame frame;
  frame.intrinsics = kCamera;
  frame.depth_unit_m = 0.0002;
  frame.depth.create(kCamera.height, kCamera.width, CV_16UC1);
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const double floor_m = 0.6 + 2.9 * v / kCamera.height;
      const double z = wall ? 1.0 : (u / 40 + v / 40) % 3 == 0 ? 0.8 * floor_m : floor_m;
      const double noisy_m = z + times * AXIAL_SIGMA_M(model, z) * normal(random);
      frame.depth.at<uint16_t>(v, u) = static_cast<uint16_t>(std::lround(noisy_m / frame.depth_unit_m));
    }
  }
  return frame;
}

void expectModel(const std::optional<DepthSensorParameters>& found, const DepthSensorParameters& model) {
  ASSERT_TRUE(found);
  const DepthSensorParameters& sensor = *found;
  EXPECT_EQ(sensor.sigma_base_m, model.sigma_base_m);
  EXPECT_EQ(sensor.sigma_growth_per_m, model.sigma_growth_per_m);
  EXPECT_EQ(noiseRemark(model, sensor), "");
}

TEST(SensorNoise, TheModelStaysWhereItHolds) {
  const DepthSensorParameters model;
  for (const double times : {0.2, 1.0, 1.5})
    for (const bool wall : {false, true})
      expectModel(raisedToNoise(frameWithNoise(times, model, wall), kRange, model), model);
}

TEST(SensorNoise, MoreNoiseIsFoundAtEachDepth) {
  const DepthSensorParameters model;
  for (const double times : {3.0, 6.0}) {
    RgbdFrame frame = frameWithNoise(times, model);
    for (const int type : {CV_16UC1, CV_32FC1}) {
      frame.depth.convertTo(frame.depth, type);
      const DepthSensorParameters raised = raisedToNoise(frame, kRange, model).value();
      for (const float z : {0.7f, 1.5f, 3.0f})
        EXPECT_NEAR(AXIAL_SIGMA_M(raised, z) / AXIAL_SIGMA_M(model, z), times, 0.2 * times) << z;
      EXPECT_EQ(raised.max_sigma_m, model.max_sigma_m);
      EXPECT_NE(noiseRemark(model, raised).find("depth_sensor/sigma_base_m: 0.0"), std::string::npos);
    }
  }
}

TEST(SensorNoise, ALittleDepthSaysNothing) {
  const DepthSensorParameters model;
  RgbdFrame frame = frameWithNoise(5.0, model);
  frame.depth.rowRange(20, kCamera.height).setTo(0);
  EXPECT_FALSE(raisedToNoise(frame, kRange, model));
}

}  // namespace
}  // namespace depth_fusion
