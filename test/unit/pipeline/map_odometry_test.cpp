// Odometry by poses in the map: its velocities, its covariances, and what happens where the map moves.
#include "depth_fusion/pipeline/map_odometry.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace depth_fusion {
namespace {

constexpr double kPeriod_s = 0.1;

TrackingResult trackedAt(const Pose& T_W_D) {
  TrackingResult result;
  result.status = TrackingStatus::kTracking;
  result.T_W_D = T_W_D;
  result.covariance = 1e-6 * Matrix6d::Identity();
  return result;
}

Pose poseOf(double rx, double ry, double rz, double x, double y, double z) {
  Vector6d twist;
  twist << rx, ry, rz, x, y, z;
  return poseFromTwist(twist);
}

// A camera at the front of a robot, looking ahead.
const Pose kMounting = poseOf(-1.2, 1.2, -1.2, 0.3, 0.0, 0.5);
const Pose kStart = poseOf(0.3, -0.2, 0.8, 1.0, 2.0, 0.5);  // of the robot, in W

// The robot drives a circle: 0.5 m/s ahead, 1 rad/s to the left.
Pose driven(int frame) {
  const double angle = 1.0 * kPeriod_s * frame;
  return kStart * poseOf(0, 0, angle, 0.5 * std::sin(angle), 0.5 * (1.0 - std::cos(angle)), 0);
}

TEST(MapOdometry, SaysTheVelocityOfTheBody) {
  MapOdometry odometry;
  EXPECT_FALSE(odometry.add(0.0, trackedAt(driven(0) * kMounting), kMounting));
  for (int frame = 1; frame < 20; ++frame) {
    const auto state = odometry.add(frame * kPeriod_s, trackedAt(driven(frame) * kMounting), kMounting);
    ASSERT_TRUE(state.has_value());
    Vector6d expected;
    expected << 0, 0, 1, 0.5, 0, 0;
    EXPECT_LT((state->velocity - expected).norm(), 1e-3) << state->velocity.transpose();
    EXPECT_TRUE(state->T_O_B.isApprox(kStart.inverse() * driven(frame), 1e-9));
    EXPECT_TRUE(odometry.T_W_O().isApprox(kStart, 1e-9));
  }
}

TEST(MapOdometry, SaysNothingOfVelocityAfterAGap) {
  MapOdometry odometry;
  odometry.add(0.0, trackedAt(driven(0)), Pose::Identity());
  EXPECT_FALSE(odometry.add(3.0, trackedAt(driven(30)), Pose::Identity()));
  const auto state = odometry.add(3.1, trackedAt(driven(31)), Pose::Identity());
  ASSERT_TRUE(state.has_value());
  EXPECT_TRUE(state->T_O_B.isApprox(kStart.inverse() * driven(31), 1e-9)) << "what the map has, it knows";
}

// Errors drawn from the covariances are as large, in their units, as they are to be (NEES 6, of six
// dimensions), wherever the body and the world are.
TEST(MapOdometry, CovariancesAreThoseOfTheErrors) {
  constexpr int kDraws = 400;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return Vector6d::NullaryExpr([&] { return normal(random); }).eval(); };
  const Matrix6d root = 1e-3 * (Matrix6d::Identity() + 0.3 * Matrix6d::Random()), drift_root = 3.0 * root;
  double pose_nees = 0.0, velocity_nees = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    MapOdometry odometry;
    TrackingResult start = trackedAt(driven(0) * kMounting);
    start.covariance.setZero();
    odometry.add(0.0, start, kMounting);
    const Vector6d drift = drift_root * draw();
    std::optional<OdometryState> state;
    for (const int frame : {1, 2}) {
      TrackingResult tracked = trackedAt(poseFromTwist(drift + root * draw()) * driven(frame) * kMounting);
      tracked.covariance = root * root.transpose();
      tracked.drift = drift_root * drift_root.transpose();
      state = odometry.add(frame * kPeriod_s, tracked, kMounting);
    }
    const Pose truth = kStart.inverse() * driven(2);
    const Vector6d error = twistFromPose(state->T_O_B * truth.inverse());
    pose_nees += error.dot(state->covariance.ldlt().solve(error)) / kDraws;
    Vector6d velocity_error = state->velocity;
    velocity_error -= (Vector6d() << 0, 0, 1, 0.5, 0, 0).finished();
    velocity_nees += velocity_error.dot(state->velocity_covariance.ldlt().solve(velocity_error)) / kDraws;
  }
  EXPECT_NEAR(pose_nees, 6.0, 0.7);
  EXPECT_NEAR(velocity_nees, 6.0, 0.7);
}

TEST(MapOdometry, DoesNotJumpWithTheMap) {
  MapOdometry odometry;
  for (int frame = 0; frame < 5; ++frame)
    odometry.add(frame * kPeriod_s, trackedAt(driven(frame) * kMounting), kMounting);
  const Pose correction = poseOf(0, 0, 0.1, 0.3, -0.2, 0);
  odometry.moveWorld([&](const StampedPose& last) { return Pose(correction * last.T_W_D); });
  EXPECT_TRUE(odometry.T_W_O().isApprox(correction * kStart, 1e-9));
  const auto state = odometry.add(5 * kPeriod_s, trackedAt(correction * driven(5) * kMounting), kMounting);
  ASSERT_TRUE(state.has_value());
  EXPECT_TRUE(state->T_O_B.isApprox(kStart.inverse() * driven(5), 1e-9));
  EXPECT_NEAR(state->velocity(3), 0.5, 1e-3);
}

TEST(MapOdometry, GoesOnInAnotherWorldLessSureOfWhereItIs) {
  MapOdometry odometry;
  odometry.add(0.0, trackedAt(driven(0)), Pose::Identity());
  const auto before = odometry.add(kPeriod_s, trackedAt(driven(1)), Pose::Identity());
  odometry.leaveWorld();
  EXPECT_FALSE(odometry.add(2 * kPeriod_s, trackedAt(Pose::Identity()), Pose::Identity()));
  const Pose step = driven(2).inverse() * driven(3);
  const auto state = odometry.add(3 * kPeriod_s, trackedAt(step), Pose::Identity());
  ASSERT_TRUE(state.has_value());
  EXPECT_TRUE(state->T_O_B.isApprox(before->T_O_B * step, 1e-9));
  EXPECT_GT(state->covariance(3, 3), 0.1);
  EXPECT_LT(state->velocity_covariance(3, 3), 1e-2) << "velocity is known again";
}

}  // namespace
}  // namespace depth_fusion
