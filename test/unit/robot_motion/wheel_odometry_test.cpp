// Odometry that is late, slow, jumps or ends.
#include "depth_fusion/robot_motion/wheel_odometry.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

constexpr double kFrame_s = 0.1, kSpeed_m_s = 0.5, kTurn_rad_s = 0.4;

// A robot that drives in a circle.
OdometryReading at(double stamp_s) {
  Vector6d twist;
  twist << 0.0, kTurn_rad_s * stamp_s, 0.0, 0.0, 0.0, 0.0;
  OdometryReading reading{stamp_s, poseFromTwist(twist)};
  reading.T_O_D.translation() =
      kSpeed_m_s / kTurn_rad_s *
      Eigen::Vector3d(1.0 - std::cos(kTurn_rad_s * stamp_s), 0.0, std::sin(kTurn_rad_s * stamp_s));
  return reading;
}

Pose trueMotion(double from_s, double to_s) { return at(from_s).T_O_D.inverse() * at(to_s).T_O_D; }

double error_m(const Pose& a, const Pose& b) { return (a.inverse() * b).translation().norm(); }

class WheelOdometryTest : public testing::Test {
 protected:
  std::optional<FrameMotion> motionTo(double stamp_s) { return odometry_.motionTo(stamp_s, parameters_); }
  double sigma_m(const FrameMotion& motion) const { return std::sqrt(motion.covariance(3, 3)); }

  RobotMotionParameters parameters_;
  WheelOdometry odometry_;
};

TEST_F(WheelOdometryTest, TellsTheMotionBetweenFramesToAPartOfTheWay) {
  for (double s = 0.0; s < 1.0; s += 0.02) odometry_.add(at(s));
  EXPECT_FALSE(motionTo(0.105)) << "there is no frame before";
  const auto motion = motionTo(0.505);
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->origin, "odometry");
  EXPECT_LT(error_m(motion->T_previous_current, trueMotion(0.105, 0.505)), 1e-4);
  EXPECT_NEAR(sigma_m(*motion), 0.001 + parameters_.odometry_distance_sigma * 0.4 * kSpeed_m_s, 2e-4);
}

TEST_F(WheelOdometryTest, WhatIsDrawnOnWronglyIsPutRightByTheNextMotion) {
  constexpr double kLate_s = 0.15;
  Pose sum = Pose::Identity();
  double now_s = 0.3, largest_sigma_m = 0.0;
  for (double s = 0.0; s < now_s - kLate_s; s += 0.02) odometry_.add(at(s));
  motionTo(now_s);
  for (int i = 0; i < 20; ++i) {
    for (double s = now_s - kLate_s; s < now_s + kFrame_s - kLate_s - 1e-9; s += 0.02) odometry_.add(at(s));
    now_s += kFrame_s;
    const auto motion = motionTo(now_s);
    ASSERT_TRUE(motion) << i;
    sum = sum * motion->T_previous_current;
    largest_sigma_m = std::max(largest_sigma_m, sigma_m(*motion));
  }
  EXPECT_LT(error_m(sum, trueMotion(0.3, now_s)), 0.01) << "of a way of a metre";
  EXPECT_GT(largest_sigma_m, 0.01) << "what is drawn on is known less well";
}

TEST_F(WheelOdometryTest, AJumpIsNoMotion) {
  odometry_.add(at(0.0));
  motionTo(0.0);
  OdometryReading far = at(0.1);
  far.T_O_D.translation().x() += 3.0;
  odometry_.add(far);
  EXPECT_FALSE(motionTo(0.1));
  far.stamp_s = 0.2;
  odometry_.add(far);
  EXPECT_TRUE(motionTo(0.2)) << "it goes on from there";
}

TEST_F(WheelOdometryTest, AfterItsEndNothingIsSaid) {
  for (double s = 0.0; s < 1.0; s += 0.02) odometry_.add(at(s));
  motionTo(0.9);
  EXPECT_TRUE(motionTo(1.2));
  EXPECT_FALSE(motionTo(1.6));
  EXPECT_FALSE(motionTo(1.7));
}

TEST_F(WheelOdometryTest, AGapInTheFramesIsBridged) {
  for (double s = 0.0; s < 10.0; s += 0.02) {
    odometry_.add(at(s));
    if (std::abs(s - 1.0) < 1e-6) motionTo(1.0);
  }
  const auto motion = motionTo(9.9);
  ASSERT_TRUE(motion);
  EXPECT_LT(error_m(motion->T_previous_current, trueMotion(1.0, 9.9)), 1e-3);
  EXPECT_NEAR(sigma_m(*motion), 0.05 * 8.9 * kSpeed_m_s, 0.01) << "by the way, not by the distance";
}

}  // namespace
}  // namespace depth_fusion
