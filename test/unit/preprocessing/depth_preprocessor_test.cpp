#include "depth_fusion/preprocessing/depth_preprocessor.h"

#include <gtest/gtest.h>

#include <limits>

#include "depth_fusion/preprocessing/depth_correction.h"
#include "support/busy_depth.h"
#include "support/expect_error.h"
#include "support/normal_images.h"
#include "support/test_compute.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

double largestDifference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

TEST(DepthPreprocessor, NewParametersAreThoseOfAFreshOne) {
  const CameraIntrinsics camera = cameraOfSize(64, 48);
  const RgbdFrame frame = frameOf(busyDepth(camera));
  PreprocessingParameters parameters;
  DepthSensorParameters sensor;
  DepthPreprocessor changed(compute(), parameters, camera, sensor);
  changed.process(frame);
  parameters.max_range_m = 1.5f;
  parameters.bilateral_sigma_px = 0.7f;
  sensor.sigma_base_m = 0.003f;
  changed.setParameters(parameters, sensor);
  DepthPreprocessor fresh(compute(), parameters, camera, sensor);
  const DepthFrame& a = changed.process(frame);
  const DepthFrame& b = fresh.process(frame);
  EXPECT_EQ(a.depth_step_m, b.depth_step_m);
  EXPECT_EQ(a.levels[0].sensor.sigma_base_m, 0.003f);
  EXPECT_EQ(a.measurements.read<uint32_t>(imageElements(camera)),
            b.measurements.read<uint32_t>(imageElements(camera)));
}

TEST(DepthPreprocessor, RefusedParametersChangeNothing) {
  const CameraIntrinsics camera = cameraOfSize(64, 48);
  PreprocessingParameters parameters;
  DepthPreprocessor preprocessor(compute(), parameters, camera);
  parameters.min_range_m = parameters.max_range_m;
  expectError([&] { preprocessor.setParameters(parameters, {}); },
              {"preprocessing/min_range_m must be below"});
  EXPECT_GT(cv::countNonZero(readImage(preprocessor.process(frameOf(busyDepth(camera))).raw_depth, camera)),
            0);
}

TEST(DepthPreprocessor, MetresOfIntegers) {
  const PreprocessingParameters parameters;
  for (const auto& [width, height] : {std::pair{100, 75}, {33, 31}, {640, 480}}) {
    const CameraIntrinsics camera = cameraOfSize(width, height);
    cv::Mat input(height, width, CV_16UC1);
    cv::RNG(5).fill(input, cv::RNG::UNIFORM, 0, 65536);
    input.at<uint16_t>(0, 0) = 65535;
    DepthPreprocessor preprocessor(compute(), parameters, camera);
    const DepthFrame& frame = preprocessor.process(frameOf(input, 0.0002));
    const RangeArgs range{0.0002f, parameters.min_range_m, parameters.max_range_m};
    EXPECT_TRUE(sameImage(readImage(frame.raw_depth, camera), reference::depthToMetres(input, range)));
    EXPECT_EQ(nonzeroPadding(frame.raw_depth, camera), 0);
  }
}

TEST(DepthPreprocessor, DepthIsCorrectedByTheOffsets) {
  PreprocessingParameters parameters;
  parameters.depth_offsets_per_m = "3 2 0.02 -0.01 0.03 0 0.05 -0.04";
  const cv::Mat grid = parseDepthOffsets(parameters.depth_offsets_per_m);
  for (const int type : {CV_16UC1, CV_32FC1}) {
    const CameraIntrinsics camera = cameraOfSize(49, 38);
    const cv::Mat offsets = spreadOffsets(grid, {camera.width, camera.height});
    cv::Mat input(camera.height, camera.width, type);
    cv::RNG(5).fill(input, cv::RNG::UNIFORM, 0, type == CV_16UC1 ? 8000 : 16);
    const double unit_m = type == CV_16UC1 ? 0.001 : 0.5;
    DepthPreprocessor preprocessor(compute(), {}, camera);
    preprocessor.setParameters(parameters, {});
    cv::Mat depth = readImage(preprocessor.process(frameOf(input, unit_m)).raw_depth, camera);
    reference::forEachPixel<float>(depth, [&](int x, int y, float& corrected) {
      const double value = type == CV_16UC1 ? input.at<uint16_t>(y, x) : input.at<float>(y, x);
      const double measured_m = value * unit_m;
      const double expected_m = measured_m / (1.0 + measured_m * offsets.at<float>(y, x));
      if (corrected == 0.0f) {
        ASSERT_TRUE(expected_m < parameters.min_range_m + 1e-5 || expected_m > parameters.max_range_m - 1e-5)
            << x << " " << y;
      } else {
        ASSERT_NEAR(corrected, expected_m, 1e-5) << x << " " << y;
      }
    });
    EXPECT_EQ(nonzeroPadding(preprocessor.process(frameOf(input, unit_m)).raw_depth, camera), 0);
  }
}

TEST(DepthPreprocessor, NoDepthWhereThereIsNoneOrOutOfRange) {
  const CameraIntrinsics camera = cameraOfSize(40, 30);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<std::pair<float, float>> cases = {
      {0.0f, 0.0f},    {nan, 0.0f},  {infinity, 0.0f}, {-infinity, 0.0f}, {-1.0f, 0.0f}, {0.4f, 0.0f},
      {1000.0f, 0.0f}, {0.5f, 0.5f}, {4.0f, 4.0f},     {4.0001f, 0.0f},   {2.0f, 2.0f},  {0.49999f, 0.0f}};
  cv::Mat input = cv::Mat::zeros(30, 40, CV_32FC1);
  for (size_t i = 0; i < cases.size(); ++i) input.at<float>(7, 25 + static_cast<int>(i)) = cases[i].first;
  PreprocessingParameters parameters;
  parameters.min_range_m = 0.5f;
  parameters.max_range_m = 4.0f;
  DepthPreprocessor preprocessor(compute(), parameters, camera);
  const cv::Mat depth = readImage(preprocessor.process(frameOf(input)).raw_depth, camera);
  for (size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(depth.at<float>(7, 25 + static_cast<int>(i)), cases[i].second) << cases[i].first;
  }
  EXPECT_EQ(cv::countNonZero(depth), 3);
}

TEST(DepthPreprocessor, EveryStepEqualsTheReference) {
  PreprocessingParameters parameters;
  for (const auto& [width, height] : {std::pair{100, 75}, {49, 38}, {640, 480}}) {
    const CameraIntrinsics camera = cameraOfSize(width, height);
    DepthPreprocessor preprocessor(compute(), parameters, camera);
    const DepthFrame& frame = preprocessor.process(frameOf(busyDepth(camera)));
    const cv::Mat raw = readImage(frame.raw_depth, camera);
    EXPECT_EQ(frame.max_tiles.read<float>(reference::maxTiles(raw).size()), reference::maxTiles(raw));

    cv::Mat expected =
        reference::filterBilateral(raw, parameters.bilateral_sigma_px, parameters.bilateral_cutoff_sigmas);
    ASSERT_EQ(frame.levels.size(), 3u);
    for (const DepthLevel& level : frame.levels) {
      const cv::Mat depth = readImage(level.depth, level.camera);
      EXPECT_LT(largestDifference(depth, expected), 2e-6) << level.camera.width;
      EXPECT_EQ(nonzeroPadding(level.depth, level.camera), 0);
      const cv::Mat normals = reference::computeNormals(depth, level.camera, parameters.max_relative_step);
      EXPECT_LT(largestDifference(readNormals(level.normals, level.camera), normals), 2e-4);
      EXPECT_EQ(nonzeroPadding(level.normals, level.camera), 0);
      expected = reference::halveDepth(depth, parameters.bilateral_cutoff_sigmas);
    }
  }
}

TEST(DepthPreprocessor, SensorLimitsTheRange) {
  const CameraIntrinsics camera = cameraOfSize(50, 40);
  DepthSensorParameters sensor;
  sensor.max_sigma_m = 0.01f;
  const double range_m = 0.4 + std::sqrt((0.01 - 0.0012) / 0.0019);
  cv::Mat depth(40, 50, CV_32FC1, cv::Scalar(range_m + 0.01));
  depth.colRange(0, 25).setTo(range_m - 0.01);
  DepthPreprocessor preprocessor(compute(), {}, camera, sensor);
  const cv::Mat in_range = readImage(preprocessor.process(frameOf(depth)).raw_depth, camera);
  EXPECT_EQ(cv::countNonZero(in_range), 25 * 40);
  EXPECT_EQ(cv::countNonZero(in_range.colRange(25, 50)), 0);
  sensor.sigma_base_m = 0.0f;
  expectError([&] { DepthPreprocessor(compute(), {}, camera, sensor); }, {"sigma_base_m"});
}

TEST(DepthPreprocessor, LevelsAreHalvedCameras) {
  const CameraIntrinsics camera = cameraOfSize(101, 75);
  DepthPreprocessor preprocessor(compute(), {}, camera);
  const DepthFrame& frame = preprocessor.process(frameOf(busyDepth(camera)));
  expectSameIntrinsics(frame.levels[0].camera, camera);
  expectSameIntrinsics(frame.levels[1].camera, halved(camera));
  expectSameIntrinsics(frame.levels[2].camera, halved(halved(camera)));
  EXPECT_EQ(frame.levels[2].camera.width, 25);
  EXPECT_EQ(frame.levels[2].camera.height, 18);
}

// The depth of the plane normal . p = offset.
cv::Mat planeDepth(const CameraIntrinsics& camera, const cv::Vec3d& normal, double offset_m) {
  cv::Mat depth(camera.height, camera.width, CV_32FC1);
  reference::forEachPixel<float>(depth, [&](int x, int y, float& pixel) {
    const cv::Vec3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
    pixel = static_cast<float>(offset_m / normal.dot(ray));
  });
  return depth;
}

void expectNormals(cv::Mat normals, const cv::Vec3d& expected, double tolerance) {
  reference::forEachPixel<cv::Vec3f>(normals, [&](int x, int y, const cv::Vec3f& pixel) {
    const int to_border = std::min({x, y, normals.cols - 1 - x, normals.rows - 1 - y});
    const double error = cv::norm(cv::Vec3d(pixel), to_border < 2 ? cv::Vec3d() : expected);
    // near the border, the filter has neighbours on one side only
    ASSERT_LT(error, to_border < 6 ? 20.0 * tolerance : tolerance) << x << " " << y;
  });
}

TEST(DepthPreprocessor, NormalsOfATiltedPlane) {
  const CameraIntrinsics camera = cameraOfSize(161, 121);
  for (const cv::Vec3d& direction : {cv::Vec3d(0, 0, -1), {0.3, -0.2, -1}, {-0.4, 0.1, -1}}) {
    const cv::Vec3d normal = direction / cv::norm(direction);
    const cv::Mat depth = planeDepth(camera, normal, -1.5);
    DepthPreprocessor preprocessor(compute(), {}, camera);
    const DepthFrame& frame = preprocessor.process(frameOf(depth));
    double tolerance = 0.005;  // halving bends slanted surfaces a little
    for (const DepthLevel& level : frame.levels) {
      expectNormals(readNormals(level.normals, level.camera), normal, tolerance);
      tolerance *= 2.0;
    }
    expectNormals(reference::computeNormals(depth, camera, 0.05), normal, 1e-4);
  }
}

TEST(DepthPreprocessor, FilterSmoothesNoiseAndKeepsEdges) {
  const CameraIntrinsics camera = cameraOfSize(120, 90);
  cv::Mat depth(camera.height, camera.width, CV_32FC1);
  cv::RNG random(11);
  reference::forEachPixel<float>(depth, [&](int x, int, float& pixel) {
    pixel = static_cast<float>((x < 60 ? 1.0 : 1.3) + random.gaussian(0.001));
  });
  DepthPreprocessor preprocessor(compute(), {}, camera);
  const cv::Mat filtered = readImage(preprocessor.process(frameOf(depth)).levels[0].depth, camera);
  for (const auto& [columns, truth_m] : {std::pair{cv::Range(0, 60), 1.0}, {cv::Range(60, 120), 1.3}}) {
    cv::Scalar mean, deviation;
    cv::meanStdDev(filtered.colRange(columns), mean, deviation);
    EXPECT_NEAR(mean[0], truth_m, 1e-4);
    EXPECT_LT(deviation[0], 0.0005);
  }
}

TEST(DepthPreprocessor, ReadsAPartOfALargerImage) {
  const CameraIntrinsics camera = cameraOfSize(50, 40);
  const cv::Mat larger = busyDepth(cameraOfSize(90, 70));
  const cv::Mat part = larger(cv::Rect(13, 9, 50, 40));
  DepthPreprocessor preprocessor(compute(), {}, camera);
  const cv::Mat of_part = readImage(preprocessor.process(frameOf(part)).levels[0].depth, camera);
  const cv::Mat of_copy = readImage(preprocessor.process(frameOf(part.clone())).levels[0].depth, camera);
  EXPECT_TRUE(sameImage(of_part, of_copy));
}

TEST(DepthPreprocessor, RefusesWhatItCannotUse) {
  const CameraIntrinsics camera = cameraOfSize(50, 40);
  DepthPreprocessor preprocessor(compute(), {}, camera);
  expectError([&] { preprocessor.process(frameOf(cv::Mat::zeros(40, 50, CV_8UC1))); }, {"16-bit", "float"});
  expectError([&] { preprocessor.process(frameOf(cv::Mat())); }, {"depth image"});
  expectError([&] { preprocessor.process(frameOf(cv::Mat::zeros(40, 51, CV_16UC1))); }, {"51x40", "50x40"});
  RgbdFrame weighted = frameOf(busyDepth(camera));
  weighted.weights = cv::Mat::ones(40, 50, CV_8UC1);
  expectError([&] { preprocessor.process(weighted); }, {"weights", "float"});
  weighted.weights = cv::Mat::ones(39, 50, CV_32FC1);
  expectError([&] { preprocessor.process(weighted); }, {"weights", "50x39", "50x40"});
  expectError([&] { DepthPreprocessor(compute(), {}, CameraIntrinsics()); }, {"--intrinsics"});
  expectError([&] { DepthPreprocessor(compute(), {}, cameraOfSize(10, 8)); }, {"10x8", "too small"});
  PreprocessingParameters parameters;
  parameters.min_range_m = parameters.max_range_m;
  expectError([&] { DepthPreprocessor(compute(), parameters, camera); }, {"min_range_m", "max_range_m"});
}

}  // namespace
}  // namespace depth_fusion
