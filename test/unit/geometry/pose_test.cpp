#include "depth_fusion/geometry/pose.h"

#include <gtest/gtest.h>

#include <cmath>

namespace depth_fusion {
namespace {

constexpr double kPi = 3.14159265358979323846;

Vector6d twist(double rx, double ry, double rz, double tx, double ty, double tz) {
  Vector6d twist;
  twist << rx, ry, rz, tx, ty, tz;
  return twist;
}

TEST(PoseFromTwist, QuarterTurnAboutZ) {
  const Pose motion = poseFromTwist(twist(0, 0, kPi / 2, 1, 2, 3));
  const Eigen::Vector3d moved = motion * Eigen::Vector3d(1, 0, 0);
  EXPECT_TRUE(moved.isApprox(Eigen::Vector3d(1, 3, 3), 1e-12)) << moved.transpose();
}

TEST(PoseFromTwist, ZeroIsIdentity) {
  EXPECT_EQ(poseFromTwist(Vector6d::Zero()).matrix(), Pose::Identity().matrix());
}

// The power series of the matrix exponential is the truth.
TEST(PoseFromTwist, RotationIsTheMatrixExponential) {
  const Eigen::Vector3d r(0.3, -0.7, 0.5);
  Eigen::Matrix3d cross;
  cross << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  Eigen::Matrix3d series = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  for (int n = 1; n < 30; ++n) {
    term = term * cross / n;
    series += term;
  }
  EXPECT_TRUE(poseFromTwist(twist(r.x(), r.y(), r.z(), 0, 0, 0)).linear().isApprox(series, 1e-12));
}

TEST(PoseFromTwist, DerivativeAtZeroIsTheCrossProduct) {
  const Eigen::Vector3d p(0.4, -1.2, 2.0);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    Vector6d step = Vector6d::Zero();
    step[i] = kStep;
    const Eigen::Vector3d numerical = (poseFromTwist(step) * p - poseFromTwist(-step) * p) / (2 * kStep);
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i % 3);
    const Eigen::Vector3d analytic = i < 3 ? Eigen::Vector3d(axis.cross(p)) : axis;
    EXPECT_TRUE(numerical.isApprox(analytic, 1e-8)) << "component " << i;
  }
}

TEST(RotationAngle, IsThatOfTheTwist) {
  for (const double angle_rad : {0.0, 1e-6, 0.3, 3.1}) {
    const Eigen::Vector3d r = angle_rad * Eigen::Vector3d(2, -1, 2) / 3.0;
    EXPECT_NEAR(rotationAngle(poseFromTwist(twist(r.x(), r.y(), r.z(), 5, 6, 7))), angle_rad, 1e-9);
  }
}

TEST(Interpolate, MovesAlongTheStraightWay) {
  const StampedPose a{10.0, poseFromTwist(twist(0, 0.2, 0, 1, 0, 0))};
  const StampedPose b{14.0, poseFromTwist(twist(0, 1.0, 0, 3, 4, 0))};
  EXPECT_TRUE(interpolate(a, b, 10.0).isApprox(a.T_W_D, 1e-12));
  EXPECT_TRUE(interpolate(a, b, 14.0).isApprox(b.T_W_D, 1e-12));
  EXPECT_TRUE(interpolate(a, b, 11.0).isApprox(poseFromTwist(twist(0, 0.4, 0, 1.5, 1, 0)), 1e-12));
  EXPECT_TRUE(interpolate(a, b, 16.0).isApprox(poseFromTwist(twist(0, 1.4, 0, 4, 6, 0)), 1e-12));
}

}  // namespace
}  // namespace depth_fusion
