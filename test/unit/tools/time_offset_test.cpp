// Time offsets and scales of trajectories that are known exactly.
#include "tools/calibration/time_offset.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/expect_error.h"
#include "tools/calibration/depth_scale.h"

namespace depth_fusion {
namespace {

constexpr double kInterval_s = 1.0 / 30.0;

// A hand that sways.
Pose swayingPose(double time_s) {
  Vector6d twist;
  twist << 0.1 * std::sin(2.1 * time_s), 0.15 * std::sin(1.7 * time_s + 1.0), 0.05 * std::cos(2.9 * time_s),
      0.2 * std::sin(1.9 * time_s + 2.0), 0.15 * std::cos(2.4 * time_s), 0.1 * std::sin(3.1 * time_s);
  return poseFromTwist(twist);
}

Pose steadyPose(double time_s) {
  Vector6d twist = Vector6d::Zero();
  twist[3] = 0.2 * time_s;
  return poseFromTwist(twist);
}

Pose noisy(const Pose& pose, cv::RNG& random) {
  Vector6d noise;
  for (int i = 0; i < 6; ++i) noise[i] = random.gaussian(0.0005);
  return pose * poseFromTwist(noise);
}

template <class PoseAt>
Trajectory trajectoryOf(const PoseAt& pose_at, int seed) {
  Trajectory trajectory;
  cv::RNG random(seed);
  for (int i = 0; i < 400; ++i)
    trajectory.push_back({i * kInterval_s, noisy(pose_at(i * kInterval_s), random)});
  return trajectory;
}

// Stamped so much too early, and at other moments than the trajectory.
template <class PoseAt>
std::vector<MeasuredMotion> motionsOf(const PoseAt& pose_at, double offset_s) {
  std::vector<MeasuredMotion> motions;
  cv::RNG random(77);
  for (int i = 4; i < 390; ++i) {
    const double from_s = (i + 0.3) * kInterval_s, to_s = from_s + kInterval_s;
    const Pose motion = pose_at(from_s + offset_s).inverse() * pose_at(to_s + offset_s);
    motions.push_back({from_s, to_s, noisy(motion, random)});
  }
  return motions;
}

TEST(TimeOffset, IsFoundWithinItsUncertainty) {
  const Trajectory trajectory = trajectoryOf(swayingPose, 1);
  for (const double offset_s : {0.0, 0.012, -0.035, 0.08}) {
    const TimeOffset found = findTimeOffset(motionsOf(swayingPose, offset_s), trajectory);
    ASSERT_TRUE(found.found) << found.reason;
    EXPECT_NEAR(found.offset_s.value, offset_s, 0.003);
    EXPECT_LT(found.offset_s.sigma, 0.004);
  }
}

TEST(TimeOffset, OutliersDoNotMoveIt) {
  std::vector<MeasuredMotion> motions = motionsOf(swayingPose, 0.02);
  for (size_t i = 0; i < motions.size(); i += 10) motions[i].T_from_to.translation().x() += 0.1;
  const TimeOffset found = findTimeOffset(motions, trajectoryOf(swayingPose, 1));
  ASSERT_TRUE(found.found) << found.reason;
  EXPECT_NEAR(found.offset_s.value, 0.02, 0.003);
}

TEST(TimeOffset, IsRefusedWithAReason) {
  const auto refused = [](const std::vector<MeasuredMotion>& motions, const Trajectory& trajectory) {
    const TimeOffset result = findTimeOffset(motions, trajectory);
    EXPECT_FALSE(result.found);
    return result.reason;
  };
  EXPECT_NE(refused(motionsOf(steadyPose, 0.01), trajectoryOf(steadyPose, 1)), "");
  EXPECT_NE(refused({}, trajectoryOf(swayingPose, 1)).find("only 0 motions"), std::string::npos);
  const Pose still = Pose::Identity();
  const auto resting = [&](double) { return still; };
  EXPECT_NE(refused(motionsOf(resting, 0.0), trajectoryOf(resting, 1)), "");
}

TEST(DepthScale, IsThatOfTheTrueTrajectory) {
  const Trajectory truth = trajectoryOf(swayingPose, 1);
  Trajectory tracked = trajectoryOf(swayingPose, 2);
  for (StampedPose& pose : tracked) pose.T_W_D.translation() /= 1.03;
  const Estimate scale = scaleAgainst(tracked, truth);
  EXPECT_NEAR(scale.value, 1.03, 0.002);
  EXPECT_GT(scale.sigma, 0.0);
  EXPECT_LT(scale.sigma, 0.002);
  expectError(
      [&] {
        scaleAgainst({tracked.begin(), tracked.begin() + 20}, truth);
      },
      {"only 20", "at least 50"});
}

TEST(DepthScale, IsThatOfAMeasuredDistance) {
  const Trajectory tracked = {{0.0, steadyPose(0.0)}, {5.0, steadyPose(5.0)}};  // 1 m
  const Estimate scale = scaleAgainst(tracked, Estimate{1.02, 0.01});
  EXPECT_NEAR(scale.value, 1.02, 1e-9);
  EXPECT_NEAR(scale.sigma, 0.0114, 0.0005);
  expectError([&] { scaleAgainst(tracked, Estimate{0.1, 0.005}); }, {"below 0.2 m"});
  expectError([&] { scaleAgainst(tracked, Estimate{5.0, 0.005}); }, {"--distance"});
}

}  // namespace
}  // namespace depth_fusion
