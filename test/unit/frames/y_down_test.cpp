// Recordings with y up give the same surface as with y down, mirrored.
#include "depth_fusion/frames/y_down.h"

#include <gtest/gtest.h>

#include "support/test_frames.h"

namespace depth_fusion {
namespace {

Pose somePose() {
  Vector6d twist;
  twist << 0.3, -0.5, 0.2, 1.0, 2.0, -3.0;
  return poseFromTwist(twist);
}

// Where a pixel at that depth lies in the world.
Eigen::Vector3d pointOf(const RgbdFrame& frame, double u, double v, double z_m) {
  const CameraIntrinsics& camera = frame.intrinsics;
  return *frame.T_W_D *
         Eigen::Vector3d((u - camera.cx) * z_m / camera.fx, (v - camera.cy) * z_m / camera.fy, z_m);
}

TEST(YDown, points_are_where_they_were_with_y_down) {
  RgbdFrame frame = testFrame(1);
  frame.intrinsics.fy = -frame.intrinsics.fy;
  frame.T_W_D = somePose();
  const Eigen::Vector3d up = pointOf(frame, 3.0, 7.0, 1.5);
  makeYDown(frame);
  EXPECT_TRUE(frame.y_mirrored);
  EXPECT_GT(frame.intrinsics.fy, 0.0);
  EXPECT_NEAR(frame.T_W_D->linear().determinant(), 1.0, 1e-12);
  EXPECT_TRUE(pointOf(frame, 3.0, 7.0, 1.5).isApprox(Eigen::Vector3d(up.x(), -up.y(), up.z()), 1e-12));
}

TEST(YDown, mirroring_twice_gives_the_pose_back) {
  EXPECT_TRUE(mirroredY(mirroredY(somePose())).isApprox(somePose(), 1e-15));
  EXPECT_TRUE(
      mirroredY(somePose() * somePose()).isApprox(mirroredY(somePose()) * mirroredY(somePose()), 1e-12));
}

TEST(YDown, frames_with_y_down_stay_as_they_are) {
  RgbdFrame frame = testFrame(1);
  frame.T_W_D = somePose();
  makeYDown(frame);
  EXPECT_FALSE(frame.y_mirrored);
  expectSameIntrinsics(frame.intrinsics, testFrame(1).intrinsics);
  EXPECT_TRUE(frame.T_W_D->isApprox(somePose(), 0.0));
}

}  // namespace
}  // namespace depth_fusion
