// Faults injected into a simulated sensor are found, and none where there are none.
#include "tools/calibration/depth_calibration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/expect_error.h"
#include "support/faulty_sensor.h"
#include "support/test_compute.h"
#include "tools/calibration/plane_patches.h"
#include "tools/plots/calibration_picture.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 60;
constexpr double kInterval_s = 0.1;
const CameraIntrinsics kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

// A sensor as far off as a bad structured-light one: 1 to 3 % of the depth at 1 m, curved and tilted.
double bent(double x, double y) {
  return 0.012 + 0.008 * (x - 0.5) - 0.03 * (x - 0.5) * (x - 0.5) + 0.02 * (y - 0.5) * (y - 0.5);
}

// The recording as tracked: the poses off by some millimetres.
std::vector<CalibrationFrame> framesOf(const FaultySensor& sensor, int count = kFrames) {
  std::vector<CalibrationFrame> frames;
  cv::RNG random(9);
  for (int i = 0; i < count; ++i) {
    const double time_s = 1.0 + kInterval_s * i;
    Vector6d error;
    for (int k = 0; k < 6; ++k) error[k] = random.gaussian(0.003);
    frames.push_back(
        {sensor.frameAt(time_s, i), sensor.poseAt(time_s) * poseFromTwist(error), sensor.velocityAt(time_s)});
  }
  return frames;
}

struct GridError {
  double mean_per_m = 0.0, rms_per_m = 0.0, largest_sigmas = 0.0;
};

// The error of the offsets that are observed.
GridError errorOf(const DepthCalibration& found, const std::function<double(double, double)>& truth) {
  GridError error;
  int count = 0;
  const cv::Mat& grid = found.offsets_per_m;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.cols; ++column) {
      const double sigma = found.sigmas_per_m.at<float>(row, column);
      if (sigma > 0.009) continue;
      const double difference =
          grid.at<float>(row, column) - truth(column / (grid.cols - 1.0), row / (grid.rows - 1.0));
      error.mean_per_m += difference;
      error.rms_per_m += difference * difference;
      error.largest_sigmas = std::max(error.largest_sigmas, std::abs(difference) / sigma);
      ++count;
    }
  }
  error.mean_per_m /= count;
  error.rms_per_m = std::sqrt(error.rms_per_m / count);
  std::printf(
      "%d offsets, error mean %.2f, rms %.2f mm at 1 m, at most %.1f sigma; %.2f -> %.2f mm; readout %.1f +- "
      "%.1f ms; %d pairs, %d planes\n",
      count, 1e3 * error.mean_per_m, 1e3 * error.rms_per_m, error.largest_sigmas,
      1e3 * found.before.rms_per_m, 1e3 * found.after.rms_per_m, 1e3 * found.readout_s.value,
      1e3 * found.readout_s.sigma, found.pairs, found.planes);
  return error;
}

TEST(DepthCalibration, FindsTheOffsetsAndTheReadoutThatWereInjected) {
  const DepthCalibration found = calibrateDepth(compute(), {}, framesOf(FaultySensor(kCamera, {bent, 0.03})));
  EXPECT_GE(found.observed_offsets, 40);
  const GridError error = errorOf(found, bent);
  EXPECT_LT(error.rms_per_m, 0.004);
  EXPECT_LT(error.largest_sigmas, 4.0);
  EXPECT_TRUE(found.readout_observed);
  EXPECT_NEAR(found.readout_s.value, 0.03, 0.006);
  EXPECT_LT(found.after.rms_per_m, 0.7 * found.before.rms_per_m);
  const cv::Mat picture = drawCalibration(found);
  EXPECT_EQ(picture.type(), CV_8UC3);
  EXPECT_GT(cv::countNonZero(picture.reshape(1) != 255), 1000);
}

TEST(DepthCalibration, FindsNothingInASoundSensor) {
  const SensorFaults none;
  const DepthCalibration found = calibrateDepth(compute(), {}, framesOf(FaultySensor(kCamera, none)));
  const GridError error = errorOf(found, none.offset_per_m);
  EXPECT_LT(error.rms_per_m, 0.002);
  EXPECT_LT(error.largest_sigmas, 3.0);
  EXPECT_NEAR(found.readout_s.value, 0.0, 0.006);
  for (const PartVerdict& part : found.parts) EXPECT_LT(part.gain_sigmas, 3.0);
}

// Planes stay planes under an offset that is the same everywhere, so that they must not ask for one; with
// derivatives at the noisy points they asked for 6 mm at 1 m.
TEST(DepthCalibration, PlanesAskForNoCommonOffset) {
  const FaultySensor sensor(kCamera, {});
  NormalEquations sum;
  DepthPreprocessor preprocessor(compute(), {}, kCamera, {});
  ResidualMap map;
  for (const CalibrationFrame& frame : framesOf(sensor, 20))
    sum.add(fitPlanes(CalibrationView(preprocessor, frame), 1, 3.0, map).equations);
  ParameterVector common = ParameterVector::Ones();
  common[kReadoutIndex] = 0.0;
  // The step of the common offset under a prior of 5 mm, as strong as one in 200 residuals.
  const double asked_per_m = -common.dot(sum.gradient) / 200.0 * 0.005 * 0.005;
  std::printf("planes ask for %.2f mm at 1 m\n", 1e3 * asked_per_m);
  EXPECT_NEAR(asked_per_m, 0.0, 0.0005);
}

TEST(DepthCalibration, RefusesFramesThatTellNothing) {
  expectError([] { calibrateDepth(compute(), {}, std::vector<CalibrationFrame>(5)); },
              {"only 5 frames", "move the sensor"});
  std::vector<CalibrationFrame> noise(12);
  for (size_t i = 0; i < noise.size(); ++i) {
    noise[i].frame.intrinsics = kCamera;
    noise[i].frame.depth = cv::Mat(kCamera.height, kCamera.width, CV_32FC1);
    cv::RNG(i + 1).fill(noise[i].frame.depth, cv::RNG::UNIFORM, 0.5, 3.0);
  }
  expectError([&] { calibrateDepth(compute(), {}, noise); }, {"no plane", "walls, floors and tables"});
}

}  // namespace
}  // namespace depth_fusion
