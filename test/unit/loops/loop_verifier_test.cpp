#include "depth_fusion/loops/loop_verifier.h"

#include <gtest/gtest.h>

#include "loops/view_surface.h"
#include "support/loop_keyframes.h"

namespace depth_fusion {
namespace {

const LoopScene& room() {
  static const LoopScene scene("room");
  return scene;
}

// Another pose that sees the same furniture.
Pose beside(const Pose& T_W_D) { return T_W_D * motionOf({1.0, 6.0, 1.0}, {0.1, 0.03, 0.08}); }

Keyframe seenFrom(const Pose& T_W_D, uint64_t seed) { return room().keyframe(T_W_D, T_W_D, 0.0, seed); }

double errorOf_m(const LoopCandidate& loop, const Pose& T_old_new) {
  return (loop.T_old_new.translation() - T_old_new.translation()).norm();
}

TEST(LoopVerifier, FindsHowTwoViewsOfAPlaceLie) {
  const Pose a = roomPose(), b = beside(a);
  LoopCandidate loop;
  ASSERT_TRUE(LoopVerifier({}).verify(seenFrom(a, 1), seenFrom(b, 2), loop)) << loop.text();
  EXPECT_LT(errorOf_m(loop, a.inverse() * b), 0.008);
  EXPECT_LT(rotationAngle(loop.T_old_new.inverse() * a.inverse() * b), 0.005);
  EXPECT_GT(loop.overlap, 0.5);
  EXPECT_LT(loop.contradicted, 0.05);
  const Vector6d off = twistFromPose(loop.T_old_new * (a.inverse() * b).inverse());
  EXPECT_LT(off.dot(loop.covariance.inverse() * off), 25.0) << "it says how sure that is";
}

TEST(LoopVerifier, AnotherViewIsNoLoop) {
  const Pose a = roomPose(), b = a * motionOf({0.0, 170.0, 0.0}, {0.0, 0.0, 0.0});
  LoopCandidate loop;
  EXPECT_FALSE(LoopVerifier({}).verify(seenFrom(a, 1), seenFrom(b, 2), loop));
  EXPECT_TRUE(loop.verdict == LoopVerdict::kFewMatches || loop.verdict == LoopVerdict::kFewInliers)
      << loop.text();
}

// The texture is the same, but where the old view has a wall, the new one sees half a metre farther.
TEST(LoopVerifier, WhatIsSeenThroughAWallIsRefused) {
  const Pose a = roomPose(), b = beside(a);
  RgbdFrame walled = room().frame(a, 1);
  const cv::Mat wall = walled.depth.rowRange(0, walled.depth.rows * 2 / 5);
  cv::Mat(wall - 0.5).copyTo(wall, wall > 0.8);
  const Keyframe open = seenFrom(b, 2);
  LoopCandidate loop;
  EXPECT_FALSE(LoopVerifier({}).verify(loopKeyframe(walled, a, 0.0), open, loop));
  EXPECT_EQ(loop.verdict, LoopVerdict::kSeenThrough) << loop.text();
  LoopCandidate reverse;
  EXPECT_FALSE(LoopVerifier({}).verify(open, loopKeyframe(walled, a, 0.0), reverse));
  EXPECT_EQ(reverse.verdict, LoopVerdict::kSeenThrough) << reverse.text();
}

TEST(LoopVerifier, APictureOfAPlaceIsNotThePlace) {
  const Pose a = roomPose();
  RgbdFrame picture = room().frame(a, 1);
  picture.depth = cv::Mat(picture.depth.size(), CV_32FC1, cv::Scalar(1.5));
  LoopCandidate loop;
  EXPECT_FALSE(LoopVerifier({}).verify(seenFrom(beside(a), 2), loopKeyframe(picture, a, 0.0), loop))
      << loop.text();
}

TEST(LoopVerifier, AKeyframeWithoutDepthIsSaidToHaveNone) {
  const Keyframe seen = seenFrom(roomPose(), 1);
  Keyframe blind = seen;
  blind.view = {};
  LoopCandidate loop;
  EXPECT_FALSE(LoopVerifier({}).verify(blind, seen, loop));
  EXPECT_EQ(loop.verdict, LoopVerdict::kNoView);
  EXPECT_NE(loop.text().find("no depth"), std::string::npos) << loop.text();
}

TEST(ContradictedShare, WhatIsHiddenIsNoContradiction) {
  const CameraIntrinsics camera{160, 120, 131.0, 131.0, 79.5, 59.5};
  cv::Mat depth_m(120, 160, CV_32FC1, cv::Scalar(3.0));
  const ViewSurface wall(KeyframeView(depth_m, camera, 160), {});
  cv::Mat with_pillar = depth_m.clone();
  with_pillar.colRange(60, 100) = 1.5;
  const ViewSurface pillar(KeyframeView(with_pillar, camera, 160), {});
  EXPECT_EQ(contradictedShare(wall, wall, Pose::Identity()), 0.0);
  EXPECT_NEAR(contradictedShare(wall, pillar, Pose::Identity()), 0.24, 0.04) << "the wall is seen through it";
  Pose aside = Pose::Identity();
  aside.translation().x() = 0.3;
  EXPECT_LT(contradictedShare(pillar, pillar, Pose::Identity()), 0.01);
  // From the side the pillar hides another part of the wall.
  cv::Mat from_aside = depth_m.clone();
  from_aside.colRange(60 - 26, 100 - 26) = 1.5;
  const ViewSurface moved(KeyframeView(from_aside, camera, 160), {});
  EXPECT_LT(contradictedShare(pillar, moved, aside), 0.02);
}

}  // namespace
}  // namespace depth_fusion
