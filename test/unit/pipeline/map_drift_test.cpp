// Drift grows over new ground, and not where the sensor has been.
#include "depth_fusion/pipeline/map_drift.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_fusion {
namespace {

constexpr double kStep_m = 0.05;

Pose at(double x, double y = 0.0) {
  Pose pose = Pose::Identity();
  pose.translation() << x, y, 0.0;
  return pose;
}

// Of the position along y: of the pose itself, not of the world's turning about its origin.
double variance(const MapDrift& drift, const Pose& pose) {
  const Matrix6d about_pose = adjoint(at(-pose.translation().x(), -pose.translation().y()));
  return (about_pose * drift.at(pose) * about_pose.transpose())(4, 4);
}

void walk(MapDrift& drift, double from_m, double to_m) {
  const int steps = static_cast<int>(std::lround(std::abs(to_m - from_m) / kStep_m));
  for (int i = 0; i <= steps; ++i) drift.add(at(from_m + (to_m - from_m) * i / steps));
}

DriftParameters none() { return {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f}; }

DriftParameters ofPosition() {
  DriftParameters parameters = none();
  parameters.m_after_1m = 0.01f;
  return parameters;
}

TEST(MapDrift, GrowsWithTheRootOfTheWay) {
  MapDrift drift(ofPosition());
  EXPECT_EQ(variance(drift, at(3.0)), 0.0) << "an empty map is where it begins";
  walk(drift, 0.0, 4.0);
  EXPECT_NEAR(variance(drift, at(1.0)), 1e-4, 1e-5);
  EXPECT_NEAR(variance(drift, at(4.0)), 4e-4, 4e-5);
}

TEST(MapDrift, DoesNotGrowWhereTheSensorHasBeen) {
  MapDrift drift(ofPosition());
  walk(drift, 0.0, 2.0);
  const double first = variance(drift, at(2.0));
  for (int i = 0; i < 10; ++i) {
    walk(drift, 2.0, 0.0);
    walk(drift, 0.0, 2.0);
  }
  EXPECT_EQ(variance(drift, at(0.0)), 0.0);
  EXPECT_NEAR(variance(drift, at(2.0)), first, 1e-9);
}

TEST(MapDrift, ATurnDisplacesWhatLiesBeyond) {
  DriftParameters parameters = none();
  parameters.rad_after_1m = 0.01f;
  MapDrift drift(parameters);
  walk(drift, 0.0, 3.0);
  // The integral of (0.01 (3 - x))^2 over the way.
  EXPECT_NEAR(variance(drift, at(3.0)), 1e-4 * 9.0, 2e-5);
  EXPECT_NEAR(drift.at(at(3.0))(2, 2), 3e-4, 3e-5);
}

TEST(MapDrift, GrowsByTurning) {
  DriftParameters parameters = none();
  parameters.rad_after_1rad = 0.01f;
  MapDrift drift(parameters);
  Pose pose = Pose::Identity();
  for (int i = 0; i <= 20; ++i) {
    pose.linear() = Eigen::AngleAxisd(0.05 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    drift.add(pose);
  }
  EXPECT_NEAR(drift.at(pose)(0, 0), 1e-4, 1e-5);
}

TEST(MapDrift, AScaleIsOffByADistanceFromTheStart) {
  DriftParameters parameters = none();
  parameters.scale = 0.01f;
  MapDrift drift(parameters);
  walk(drift, 1.0, 4.0);
  EXPECT_NEAR(drift.at(at(4.0))(3, 3), 9e-4, 1e-9);
  EXPECT_NEAR(drift.at(at(1.0))(3, 3), 0.0, 1e-12);
}

// All that is tracked stands on the first frame, and has its noise.
TEST(MapDrift, BeginsWithTheNoiseOfTheFirstFrame) {
  const Matrix6d noise = 1e-6 * Matrix6d::Identity();
  MapDrift drift(none());
  drift.add(at(0.0));
  EXPECT_TRUE(drift.at(at(0.0), noise).isApprox(noise)) << "the second frame";
  drift.add(at(0.0), noise);
  drift.add(at(1.0), noise);
  EXPECT_TRUE(drift.at(at(1.0), noise).isApprox(noise)) << "the third is not that of another one";
}

// What priors left in a frame stays in what is mapped from there on.
TEST(MapDrift, HoldsWhatPriorsLeave) {
  const Matrix6d carried = 1e-4 * Matrix6d::Identity();
  MapDrift drift(none());
  EXPECT_TRUE(drift.add(at(0.0)));
  EXPECT_FALSE(drift.add(at(0.02), Matrix6d::Zero(), carried)) << "that is known ground";
  EXPECT_TRUE(drift.add(at(0.2), Matrix6d::Zero(), carried));
  EXPECT_TRUE(drift.add(at(0.4)));
  EXPECT_TRUE(drift.at(at(0.4)).isApprox(carried));
  EXPECT_EQ(variance(drift, at(0.0)), 0.0);
}

// A map whose loop is closed is as sure at its end as at its beginning, and halfway by the shorter way.
TEST(MapDrift, GoesTheShorterWayRoundAClosedLoop) {
  std::vector<Pose> ring;
  for (int i = 0; i <= 100; ++i) {
    const double angle = 2.0 * 3.141592653589793 * i / 100.0;
    ring.push_back(at(2.0 * std::cos(angle), 2.0 * std::sin(angle)));
  }
  MapDrift drift(ofPosition());
  drift.reset(ring);
  EXPECT_NEAR(variance(drift, ring[100]), 0.0, 1e-6);
  EXPECT_NEAR(variance(drift, ring[90]), variance(drift, ring[10]), 1e-6);
  EXPECT_NEAR(variance(drift, ring[50]), 1e-4 * 2.0 * 3.141592653589793, 1e-4);
}

}  // namespace
}  // namespace depth_fusion
