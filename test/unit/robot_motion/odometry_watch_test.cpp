// Odometry that contradicts the camera: what is said of it.
#include "depth_fusion/robot_motion/odometry_watch.h"

#include <gtest/gtest.h>

#include <functional>

namespace depth_fusion {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;

// A robot that drives with changing speed round bends; z is ahead and y down.
Pose way(double time_s) {
  const double yaw = 0.6 * std::sin(1.1 * time_s), along = 0.4 * time_s + 0.15 * std::sin(1.9 * time_s);
  Pose pose = poseFromTwist((Vector6d() << 0.0, yaw, 0.0, 0.0, 0.0, 0.0).finished());
  pose.translation() = Eigen::Vector3d(std::sin(0.3 * along), 0.0, along);
  return pose;
}

Pose motion(double to_s) { return orthonormalized(way(to_s - kFrame_s).inverse() * way(to_s)); }

std::string problemWith(const std::function<Pose(double to_s)>& odometry) {
  OdometryWatch watch;
  const RobotMotionParameters parameters;
  for (int i = 1; i < 360; ++i)
    watch.add({i * kFrame_s, kFrame_s, motion(i * kFrame_s), odometry(i * kFrame_s)}, parameters);
  return watch.problem();
}

TEST(OdometryWatch, NothingIsSaidOfOdometryThatDriftsALittle) {
  EXPECT_EQ(problemWith([](double to_s) {
              Vector6d twist = twistFromPose(motion(to_s));
              return poseFromTwist(1.03 * twist);
            }),
            "");
}

TEST(OdometryWatch, TheOffsetOfItsStampsIsOffered) {
  const std::string problem = problemWith([](double to_s) { return motion(to_s - 0.2); });
  EXPECT_NE(problem.find("odometry contradicts the camera"), std::string::npos) << problem;
  EXPECT_NE(problem.find("its stamps are about 200 ms too late; correct them by -200 ms"), std::string::npos)
      << problem;
}

TEST(OdometryWatch, TheCamerasRotationOnTheRobotIsOffered) {
  const Pose tf_from_camera = poseFromTwist((Vector6d() << 0.0, 0.35, 0.0, 0.0, 0.0, 0.0).finished());
  const std::string problem =
      problemWith([&](double to_s) { return tf_from_camera * motion(to_s) * tf_from_camera.inverse(); });
  EXPECT_NE(problem.find("turned by 20.1 degrees"), std::string::npos) << problem;
  EXPECT_NE(problem.find("y +20.1"), std::string::npos) << problem;
}

TEST(OdometryWatch, WheelsThatSlipAreSaidToDoSo) {
  const std::string problem = problemWith([](double to_s) {
    Pose slipping = motion(to_s);
    slipping.translation() *= 1.6;
    return slipping;
  });
  EXPECT_NE(problem.find("do the wheels slip"), std::string::npos) << problem;
}

}  // namespace
}  // namespace depth_fusion
