// Trajectory errors against known motions and known noise.
#include "tools/evaluation/trajectory_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "depth_fusion/common/error.h"
#include "tools/plots/trajectory_plot.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.141592653589793;

Trajectory curve(int poses = 300, double fps = 30.0) {
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i) {
    const double t = i / fps;
    Vector6d twist;
    twist << 0.3 * std::sin(t), 0.2 * t, 0.1 * std::cos(0.7 * t), std::cos(t), 0.5 * std::sin(1.3 * t),
        0.2 * t;
    trajectory.push_back({10.0 + t, poseFromTwist(twist)});
  }
  return trajectory;
}

Pose someMotion() {
  Vector6d twist;
  twist << 0.7, -1.1, 0.4, 3.0, -2.0, 0.5;
  return poseFromTwist(twist);
}

Trajectory moved(const Pose& T_A_W, Trajectory trajectory) {
  for (StampedPose& pose : trajectory) pose.T_W_D = T_A_W * pose.T_W_D;
  return trajectory;
}

TEST(Statistics, OfKnownNumbers) {
  const ErrorStatistics statistics = statisticsOf({4.0, 1.0, 2.0, 3.0});
  EXPECT_EQ(statistics.count, 4u);
  EXPECT_DOUBLE_EQ(statistics.mean, 2.5);
  EXPECT_DOUBLE_EQ(statistics.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(statistics.median, 2.0);
  EXPECT_DOUBLE_EQ(statistics.percentile95, 4.0);
  EXPECT_DOUBLE_EQ(statistics.max, 4.0);
  EXPECT_EQ(statisticsOf({}).count, 0u);
}

TEST(TrajectoryError, RigidMotionOfTheWorldIsNoError) {
  const Trajectory truth = curve();
  const Pose T_A_W = someMotion();
  const TrajectoryError error = compareTrajectories(moved(T_A_W, truth), truth);
  EXPECT_EQ(error.pairs.size(), truth.size());
  EXPECT_LT(error.ate_m.max, 1e-9);
  EXPECT_LT(error.rpe_translation_m.max, 1e-9);
  EXPECT_LT(error.rpe_rotation_deg.max, 1e-5);
  EXPECT_TRUE(error.T_W_E.isApprox(T_A_W.inverse(), 1e-9));
}

TEST(TrajectoryError, ScaleIsAnError) {
  const Trajectory truth = curve();
  Trajectory estimate = truth;
  for (StampedPose& pose : estimate) pose.T_W_D.translation() *= 1.1;
  EXPECT_GT(compareTrajectories(estimate, truth).ate_m.rmse, 0.05);
}

TEST(TrajectoryError, AteIsTheInjectedNoise) {
  constexpr double kSigma_m = 0.01;
  const Trajectory truth = curve(3000, 300.0);
  Trajectory estimate = moved(someMotion(), truth);
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0.0, kSigma_m);
  for (StampedPose& pose : estimate) {
    pose.T_W_D.translation() += Vector3d(noise(random), noise(random), noise(random));
  }
  const TrajectoryError error = compareTrajectories(estimate, truth);
  EXPECT_NEAR(error.ate_m.rmse, std::sqrt(3.0) * kSigma_m, 0.03 * kSigma_m);
  EXPECT_NEAR(error.ate_m.mean, std::sqrt(8.0 / kPi) * kSigma_m, 0.03 * kSigma_m);
}

TEST(TrajectoryError, RpeOfASteadyDrift) {
  // A camera that stands still, estimated to slide along its x axis at 20 mm/s and to turn about it at 3
  // deg/s.
  Trajectory still, drifting;
  for (int i = 0; i < 90; ++i) {
    const double t = i / 30.0;
    still.push_back({t, someMotion()});
    Vector6d drift = Vector6d::Zero();
    drift[0] = 3.0 * kPi / 180.0 * t;
    drift[3] = 0.02 * t;
    drifting.push_back({t, someMotion() * poseFromTwist(drift)});
  }
  const TrajectoryError error = compareTrajectories(drifting, still);
  EXPECT_EQ(error.rpe_translation_m.count, 60u);
  EXPECT_NEAR(error.rpe_translation_m.mean, 0.02, 1e-9);
  EXPECT_NEAR(error.rpe_translation_m.max, 0.02, 1e-9);
  EXPECT_NEAR(error.rpe_rotation_deg.mean, 3.0, 1e-6);
  EXPECT_NEAR(error.rpe_rotation_deg.max, 3.0, 1e-6);
}

TEST(TrajectoryError, TruthIsInterpolatedOnlyOverShortGaps) {
  Trajectory truth = curve(300, 100.0);
  Trajectory estimate;
  for (size_t i = 0; i + 1 < truth.size(); i += 3) {
    const double stamp_s = truth[i].stamp_s + 0.004;
    estimate.push_back({stamp_s, interpolate(truth[i], truth[i + 1], stamp_s)});
  }
  EXPECT_LT(compareTrajectories(estimate, truth).ate_m.max, 1e-9);

  truth.erase(truth.begin() + 100, truth.begin() + 200);
  const TrajectoryError error = compareTrajectories(estimate, truth);
  EXPECT_LT(error.ate_m.max, 1e-9);
  EXPECT_NEAR(static_cast<double>(error.pairs.size()), 66.0, 2.0);
}

TEST(TrajectoryError, OtherTimesAreRefusedNamingBoth) {
  Trajectory late = curve();
  for (StampedPose& pose : late) pose.stamp_s += 100.0;
  try {
    compareTrajectories(late, curve());
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("110.000"), std::string::npos) << text;
    EXPECT_NE(text.find("10.000"), std::string::npos) << text;
  }
  EXPECT_THROW(compareTrajectories({}, curve()), Error);
  EXPECT_THROW(compareTrajectories(curve(), {}), Error);
}

TEST(TrajectoryPlot, ShowsTheErrorInColour) {
  const Trajectory truth = curve();
  Trajectory estimate = truth;
  estimate[150].T_W_D.translation().x() += 0.1;
  const cv::Mat plot = plotTrajectories(compareTrajectories(estimate, truth));
  ASSERT_EQ(plot.type(), CV_8UC3);
  int coloured = 0;
  for (int y = 0; y < plot.rows; ++y) {
    for (int x = 0; x < 1440; ++x) {
      const cv::Vec3b pixel = plot.at<cv::Vec3b>(y, x);
      if (std::max({pixel[0], pixel[1], pixel[2]}) - std::min({pixel[0], pixel[1], pixel[2]}) > 40)
        ++coloured;
    }
  }
  EXPECT_GT(coloured, 1000);
  EXPECT_LT(coloured, plot.rows * 1440 / 10);
}

}  // namespace
}  // namespace depth_fusion
