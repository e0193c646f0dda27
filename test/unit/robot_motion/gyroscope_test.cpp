// The rotation between frames, and the bias that tracking teaches.
#include "depth_fusion/robot_motion/gyroscope.h"

#include <gtest/gtest.h>

#include "depth_fusion/robot_motion/gravity.h"
#include "tools/simulation/simulated_robot.h"

namespace depth_fusion {
namespace {

constexpr double kFrame_s = 0.1;

// A camera that sways about all axes, and is held aslant.
Pose swaying(double time_s) {
  Vector6d twist;
  twist << 0.5 * std::sin(2.0 * time_s), 0.8 * std::sin(1.3 * time_s), 0.3 * std::sin(1.7 * time_s),
      0.1 * std::sin(time_s), 0.0, 0.0;
  return poseFromTwist((Vector6d() << -2.0, 0.0, 0.0, 0.0, 0.0, 1.0).finished()) * poseFromTwist(twist);
}

SimulatedRobot robotWithImu() {
  RobotOptions options;
  options.has_imu = true;
  return {options, swaying, Pose::Identity(), 0.0, 1};
}

TEST(Gyroscope, ItsBiasIsLearntAndItsRotationIsRightToItsCovariance) {
  SimulatedRobot robot = robotWithImu();
  Gyroscope gyroscope;
  const RobotMotionParameters parameters;
  double worst_sigmas = 0.0, last_error_rad = 0.0;
  for (int i = 0; i < 300; ++i) {
    for (const ImuReading& reading : robot.until(i * kFrame_s).imu) gyroscope.add(reading);
    const auto motion = gyroscope.motionTo(i * kFrame_s, parameters);
    if (i == 0) continue;
    ASSERT_TRUE(motion) << i;
    const Pose truth = swaying((i - 1) * kFrame_s).inverse() * swaying(i * kFrame_s);
    last_error_rad = rotationAngle(truth.inverse() * motion->T_previous_current);
    worst_sigmas = std::max(worst_sigmas, last_error_rad / std::sqrt(3.0 * motion->covariance(0, 0)));
    gyroscope.learn(truth.linear(), parameters);
  }
  EXPECT_LT(worst_sigmas, 3.0);
  EXPECT_LT((gyroscope.bias_rad_s() - Eigen::Vector3d::Constant(0.01)).norm(), 0.004);
  EXPECT_LT(last_error_rad, 0.002);
}

TEST(Gyroscope, ReadingsThatAreMissingTellNothing) {
  Gyroscope gyroscope;
  const RobotMotionParameters parameters;
  const auto add = [&](double from_s, double to_s) {
    for (double s = from_s; s < to_s; s += 0.005) gyroscope.add({s, Eigen::Vector3d::Zero(), {}});
  };
  add(0.0, 0.5);
  gyroscope.motionTo(0.2, parameters);
  EXPECT_TRUE(gyroscope.motionTo(0.4, parameters));
  EXPECT_FALSE(gyroscope.motionTo(0.8, parameters));
  add(1.0, 1.5);
  EXPECT_FALSE(gyroscope.motionTo(1.2, parameters));
  EXPECT_TRUE(gyroscope.motionTo(1.4, parameters));
}

TEST(Gravity, IsKnownToADegreeWhileTheSensorSways) {
  SimulatedRobot robot = robotWithImu();
  Gravity gravity;
  EXPECT_FALSE(gravity.up_D());
  for (int i = 0; i < 100; ++i) {
    for (const ImuReading& reading : robot.until(i * kFrame_s).imu)
      gravity.add(reading, Eigen::Vector3d::Constant(0.01));
    if (i == 0) continue;
    ASSERT_TRUE(gravity.up_D());
    const Eigen::Vector3d truth = swaying(i * kFrame_s).linear().transpose() * Eigen::Vector3d::UnitZ();
    EXPECT_LT(std::acos(std::min(gravity.up_D()->dot(truth), 1.0)), 0.02) << i;
  }
}

TEST(Gravity, AForceThatIsNotThatOfGravityCountsNothing) {
  Gravity gravity;
  for (int i = 0; i < 50; ++i) {
    const bool is_shock = i % 2 == 1;
    gravity.add({0.01 * i, Eigen::Vector3d::Zero(), Eigen::Vector3d(is_shock ? 9.0 : 0.0, -9.81, 0.0)},
                Eigen::Vector3d::Zero());
  }
  EXPECT_LT((*gravity.up_D() + Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

}  // namespace
}  // namespace depth_fusion
