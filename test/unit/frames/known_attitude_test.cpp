// Gravity and a flat floor as measurements of a pose.
#include "depth_fusion/frames/known_attitude.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

Vector6d twist(double rx, double ry, double rz, double x, double y, double z) {
  return (Vector6d() << rx, ry, rz, x, y, z).finished();
}

const Pose kLevel = levelPose(kCameraUp);

TEST(KnownAttitude, ALevelCameraLooksAlongXWithZUp) {
  EXPECT_TRUE((kLevel.linear() * Vector3d::UnitZ()).isApprox(Vector3d::UnitX()));
  EXPECT_TRUE((kLevel.linear() * Vector3d::UnitX()).isApprox(-Vector3d::UnitY()));
  for (const Vector3d& up : {Vector3d(0.3, -0.8, -0.5), Vector3d(0.0, 0.01, 1.0), Vector3d(0.0, 0.0, -1.0)}) {
    const Pose pose = levelPose(up.normalized());
    EXPECT_TRUE((pose.linear() * up.normalized()).isApprox(Vector3d::UnitZ()));
    EXPECT_NEAR(pose.linear().determinant(), 1.0, 1e-9);
  }
}

TEST(KnownAttitude, GravityMeasuresTheErrorOfRollAndPitchAlone) {
  const Pose truth = poseFromTwist(twist(0.0, 0.0, 0.7, 2.0, -1.0, 0.4)) * kLevel;
  const Vector6d error = twist(0.02, -0.03, 0.0, 0.0, 0.0, 0.0);
  const KnownAttitude gravity{Vector3d(truth.linear().transpose() * Vector3d::UnitZ()), 0.01};
  MotionPrior prior{poseFromTwist(error) * truth, std::nullopt, "test"};
  const Pose before = prior.T_W_D;
  gravity.addTo(prior);
  EXPECT_TRUE(prior.T_W_D.isApprox(before)) << "the start stays where it is";
  EXPECT_LT((prior.measured_pose->error - error).norm(), 1e-3);
  const Matrix6d& information = prior.measured_pose->information;
  EXPECT_NEAR(information(0, 0), 1e4, 1e-6);
  EXPECT_TRUE(information.bottomRightCorner(4, 4).isZero()) << "heading and place are not measured";
}

TEST(KnownAttitude, AGroundRobotIsMovedToTheFloor) {
  const Pose T_B_D = poseFromTwist(twist(0.0, 0.1, 0.0, 0.2, 0.0, 0.5)) * kLevel;
  KnownAttitude floor;
  floor.T_D_B = T_B_D.inverse();
  floor.base_height_m = 0.1;
  MotionPrior prior{poseFromTwist(twist(0.05, -0.1, 0.8, 3.0, 1.0, 0.3)) * T_B_D, std::nullopt, "test"};
  const Vector3d before = (prior.T_W_D * *floor.T_D_B).translation();
  floor.addTo(prior);
  const Pose T_W_B = prior.T_W_D * *floor.T_D_B;
  EXPECT_TRUE((T_W_B.linear() * Vector3d::UnitZ()).isApprox(Vector3d::UnitZ()));
  EXPECT_NEAR(T_W_B.translation().z(), 0.1, 1e-9);
  EXPECT_LT((T_W_B.translation() - before).head<2>().norm(), 1e-9);
  // What the floor holds: a move in x, y and yaw about the base costs nothing, and all else does.
  const Matrix6d& information = prior.measured_pose->information;
  const auto cost = [&](const Vector6d& about_base) {
    const Vector6d moved = adjoint(Pose(Eigen::Translation3d(T_W_B.translation()))) * about_base;
    return moved.dot(information * moved);
  };
  EXPECT_NEAR(cost(twist(0.0, 0.0, 0.1, 0.5, -0.5, 0.0)), 0.0, 1e-3);
  for (const int axis : {0, 1, 5}) EXPECT_GT(cost(0.001 * Vector6d::Unit(axis)), 100.0) << axis;
}

TEST(KnownAttitude, AMapThatIsNotLevelIsFoundOut) {
  const KnownAttitude gravity{kCameraUp, 0.01};
  EXPECT_TRUE(gravity.agreesAt(poseFromTwist(twist(0.03, 0.0, 1.0, 0.0, 0.0, 0.0)) * kLevel));
  EXPECT_FALSE(gravity.agreesAt(poseFromTwist(twist(0.2, 0.0, 1.0, 0.0, 0.0, 0.0)) * kLevel));
  EXPECT_FALSE(gravity.agreesAt(Pose::Identity()));
}

}  // namespace
}  // namespace depth_fusion
