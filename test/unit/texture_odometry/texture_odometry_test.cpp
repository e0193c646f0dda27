// Texture odometry on the simulated room, with the noise of a Kinect and of a colour camera.
#include "depth_fusion/texture_odometry/texture_odometry.h"

#include <gtest/gtest.h>

#include "depth_fusion/geometry/angles.h"
#include "support/simulated_frames.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

const CameraIntrinsics kCamera{640, 480, 525.0, 525.0, 319.5, 239.5};

const SimulatedScene& room() {
  static const SimulatedScene scene = makeScene("room");
  return scene;
}

RenderedView viewFrom(const Pose& T_W_D) { return render(room().surface, kCamera, T_W_D); }

RgbdFrame sensed(const RenderedView& view, uint64_t seed) {
  return frameOf(view, room().sensor, kCamera, seed);
}

const RenderedView& firstView() {
  static const RenderedView view = viewFrom(roomPose());
  return view;
}

const Pose& someMotion() {
  static const Pose motion = motionOf({0.5, -0.8, 0.3}, {0.015, -0.01, 0.012});
  return motion;
}

const RenderedView& secondView() {
  static const RenderedView view = viewFrom(roomPose() * someMotion());
  return view;
}

TextureOdometryResult motionBetween(const RgbdFrame& previous, const RgbdFrame& current,
                                    const TextureOdometryParameters& parameters = {}) {
  TextureOdometry odometry(parameters);
  odometry.process(previous);
  return odometry.process(current);
}

Pose errorOf(const TextureOdometryResult& result, const Pose& truth) {
  return result.T_previous_current * truth.inverse();
}

void expectMotion(const TextureOdometryResult& result, const Pose& truth, double max_m, double max_deg) {
  ASSERT_TRUE(result.found) << result.reason;
  const Pose error = truth.inverse() * result.T_previous_current;
  EXPECT_LT(error.translation().norm(), max_m);
  EXPECT_LT(rotationAngle(error) * kDegPerRad, max_deg);
}

TEST(TextureOdometry, KnownMotions) {
  struct Case {
    Pose motion;
    double max_m, max_deg;
  };
  const std::vector<Case> cases = {
      {Pose::Identity(), 0.0005, 0.01},
      {someMotion(), 0.001, 0.02},
      {motionOf({3.0, 5.0, -1.5}, {0.08, -0.03, 0.05}), 0.003, 0.1},
      {motionOf({0.0, 0.0, 6.0}, {0.0, 0.06, 0.08}), 0.003, 0.1},
  };
  for (const Case& known : cases) {
    SCOPED_TRACE(rotationAngle(known.motion) * kDegPerRad);
    const RenderedView view = viewFrom(roomPose() * known.motion);
    const TextureOdometryResult result = motionBetween(sensed(firstView(), 1), sensed(view, 2));
    expectMotion(result, known.motion, known.max_m, known.max_deg);
    EXPECT_GE(result.features, result.matches);
    EXPECT_GE(result.matches, result.inliers);
  }
}

TEST(TextureOdometry, DepthInOneFrameIsEnough) {
  for (const bool in_previous : {true, false}) {
    RgbdFrame previous = sensed(firstView(), 1), current = sensed(secondView(), 2);
    (in_previous ? current : previous).depth.setTo(0.0f);
    expectMotion(motionBetween(previous, current), someMotion(), 0.002, 0.05);
  }
}

// Half a scanner's depth is 1 mm off: 20 of its standard deviations, and less than one of a Kinect's.
TEST(TextureOdometry, DepthErrorsCountBySensor) {
  SimulationOptions options;
  options.scene = "seal";
  const SimulatedRecording recording(options);
  const auto frameAt = [&](int i) {
    const RenderedView view =
        render(recording.scene().surface, recording.intrinsics(), recording.poseOf(i).T_W_D);
    return frameOf(view, partScanner(), recording.intrinsics(), i);
  };
  const RgbdFrame previous = frameAt(0);
  RgbdFrame current = frameAt(1);
  const cv::Mat right_half = current.depth.colRange(320, 640);
  cv::add(right_half, 0.001, right_half, right_half > 0.0f);
  DepthSensorParameters scanner;
  scanner.sigma_base_m = 0.00005f;
  scanner.sigma_growth_per_m = 0.0002f;
  scanner.sigma_from_m = 0.2f;
  const auto motionBy = [&](const DepthSensorParameters& sensor) {
    TextureOdometry odometry({}, sensor);
    odometry.process(previous);
    return odometry.process(current);
  };
  const TextureOdometryResult by_scanner = motionBy(scanner), by_kinect = motionBy({});
  ASSERT_TRUE(by_scanner.found && by_kinect.found) << by_scanner.reason << by_kinect.reason;
  EXPECT_GT(by_kinect.inliers, 0.85 * by_kinect.matches);
  EXPECT_LT(by_scanner.inliers, 0.75 * by_scanner.matches);
}

TEST(TextureOdometry, ColourBesideTheDepthCamera) {
  CameraIntrinsics color_camera{800, 600, 640.0, 645.0, 405.0, 296.0};
  const Pose T_C_D = motionOf({0.4, -0.6, 0.8}, {-0.025, 0.004, 0.002});
  const auto frameFrom = [&](const Pose& T_W_D, uint64_t seed) {
    RgbdFrame frame = sensed(viewFrom(T_W_D), seed);
    frame.color = render(room().surface, color_camera, T_W_D * T_C_D.inverse()).color;
    frame.color_intrinsics = color_camera;
    frame.T_C_D = T_C_D;
    return frame;
  };
  const RgbdFrame previous = frameFrom(roomPose(), 1);
  RgbdFrame current = frameFrom(roomPose() * someMotion(), 2);
  expectMotion(motionBetween(previous, current), someMotion(), 0.001, 0.03);

  current.color_intrinsics->width = 640;
  EXPECT_EQ(motionBetween(previous, current).reason,
            "the colour image is 800x600, its intrinsics are for 640x600; give the colour camera's own "
            "intrinsics, or colour of that size");
}

TEST(TextureOdometry, ReasonsInsteadOfAMotion) {
  const RgbdFrame good = sensed(firstView(), 1);
  RgbdFrame white = good, colorless = good, depthless = good;
  white.color = cv::Mat(good.color.size(), CV_8UC3, cv::Scalar::all(230));
  colorless.color.release();
  depthless.depth = cv::Mat(good.depth.size(), CV_32FC1, cv::Scalar(0.0));

  TextureOdometry odometry({});
  EXPECT_EQ(odometry.process(good).reason, "reference: the first frame");
  EXPECT_EQ(odometry.process(good).reason, "");
  EXPECT_EQ(odometry.process(white).reason, "only 0 features");
  EXPECT_EQ(odometry.process(good).reason, "reference: only 0 features");
  EXPECT_EQ(odometry.process(colorless).reason, "no colour image");
  EXPECT_EQ(motionBetween(depthless, depthless).reason, "only 0 matches with depth");
  odometry.reset();
  EXPECT_FALSE(odometry.process(good).found);
}

TEST(TextureOdometry, AnotherPlaceIsNoMatch) {
  const RgbdFrame elsewhere = sensed(viewFrom(roomPose() * motionOf({0.0, 150.0, 0.0}, {0.0, 0.0, 0.0})), 2);
  const TextureOdometry odometry({});
  const FrameFeatures here = odometry.extract(sensed(firstView(), 1)), there = odometry.extract(elsewhere);
  for (const bool anywhere : {false, true}) {
    const TextureOdometryResult result = odometry.match(here, there, anywhere);
    EXPECT_FALSE(result.found);
    EXPECT_NE(result.reason.find("only"), std::string::npos) << result.reason;
  }
}

TEST(TextureOdometry, KeyframeWithoutImagesIsMatchedAcrossALargeTurn) {
  const Pose motion = motionOf({2.0, 16.0, -3.0}, {0.1, 0.05, 0.05});
  const TextureOdometry odometry({});
  FrameFeatures keyframe = odometry.extract(sensed(firstView(), 1));
  keyframe.smoothed_levels.clear();
  const FrameFeatures current = odometry.extract(sensed(viewFrom(roomPose() * motion), 2));
  expectMotion(odometry.match(keyframe, current, true), motion, 0.01, 0.3);
}

TEST(TextureOdometry, TheSameAtEveryRun) {
  const RgbdFrame previous = sensed(firstView(), 1), current = sensed(secondView(), 2);
  const TextureOdometryResult a = motionBetween(previous, current), b = motionBetween(previous, current);
  EXPECT_EQ(a.T_previous_current.matrix(), b.T_previous_current.matrix());
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.inliers, b.inliers);
}

TEST(TextureOdometry, CovarianceIsThatOfTheErrors) {
  constexpr int kTrials = 30;
  TextureOdometryParameters parameters;
  parameters.shared_error = 0.0f;
  Vector6d squared_errors = Vector6d::Zero(), variances = Vector6d::Zero();
  for (int trial = 0; trial < kTrials; ++trial) {
    const TextureOdometryResult result = motionBetween(sensed(firstView(), 100 + 2 * trial),
                                                       sensed(secondView(), 101 + 2 * trial), parameters);
    ASSERT_TRUE(result.found) << result.reason;
    const Pose error = errorOf(result, someMotion());
    const Eigen::AngleAxisd rotation(error.linear());
    Vector6d twist;
    twist << rotation.angle() * rotation.axis(), error.translation();
    squared_errors += twist.cwiseAbs2() / kTrials;
    variances += result.covariance.diagonal() / kTrials;
  }
  for (int i = 0; i < 6; ++i) {
    const double ratio = std::sqrt(squared_errors[i] / variances[i]);
    EXPECT_GT(ratio, 0.5) << "of the error's component " << i;
    EXPECT_LT(ratio, 2.0) << "of the error's component " << i;
  }
}

}  // namespace
}  // namespace depth_fusion
