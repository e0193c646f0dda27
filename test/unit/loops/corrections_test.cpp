#include "depth_fusion/loops/corrections.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

Pose at(double x_m, double turn_rad = 0.0) {
  Pose pose(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()));
  pose.translation().x() = x_m;
  return pose;
}

TEST(Corrections, BlendByTimeBetweenKeyframes) {
  const Corrections corrections({{3.0, at(3.0), at(3.2)}, {0.0, at(0.0), at(0.0)}, {2.0, at(2.0), at(2.2)}});
  const auto x_of = [&](double x_m, double stamp_s) {
    return corrections.corrected({stamp_s, at(x_m)}).translation().x();
  };
  EXPECT_NEAR(x_of(0.5, 0.5), 0.55, 1e-12);
  EXPECT_NEAR(x_of(2.0, 2.0), 2.2, 1e-12);
  EXPECT_NEAR(x_of(2.5, 2.5), 2.7, 1e-12);
  EXPECT_NEAR(x_of(9.0, 9.0), 9.2, 1e-12) << "after the last";
  EXPECT_NEAR(x_of(-1.0, -1.0), -1.0, 1e-12) << "before the first";
  EXPECT_TRUE(Corrections().corrected({1.0, at(1.0)}).isApprox(at(1.0)));
  EXPECT_NEAR(corrections.largestMove_m(), 0.2, 1e-12);
  EXPECT_EQ(Corrections().largestMove_m(), 0.0);
}

// Frames after the last keyframe of a stretch have nothing of the next one, wherever that is moved.
TEST(Corrections, StretchesAreNotBlended) {
  const Corrections corrections({{0.0, at(0.0), at(0.1), 0, 0}, {4.0, at(0.0), at(9.0), 1, 1}});
  EXPECT_NEAR(corrections.corrected({3.0, at(0.5)}).translation().x(), 0.6, 1e-12);
  EXPECT_NEAR(corrections.corrected({4.5, at(0.5)}).translation().x(), 9.5, 1e-12);
  EXPECT_EQ(corrections.partAt(-1.0), 0u);
  EXPECT_EQ(corrections.partAt(3.9), 0u);
  EXPECT_EQ(corrections.partAt(4.0), 1u);
}

TEST(Corrections, PartsAreApartUntilALoopJoinsThem) {
  const auto areApart = [](std::vector<uint32_t> parts) {
    std::vector<CorrectedKeyframe> keyframes;
    for (const uint32_t part : parts) keyframes.push_back({0.0, at(0.0), at(0.0), part, part});
    return Corrections(keyframes).isApart();
  };
  EXPECT_TRUE(areApart({0, 0, 2, 2}));
  EXPECT_TRUE(areApart({0, 0, 2}));
  EXPECT_FALSE(areApart({0, 0, 0}));
  EXPECT_FALSE(areApart({0, 1, 0})) << "what was left after one keyframe does not count";
  EXPECT_FALSE(areApart({}));
}

TEST(Corrections, AFrameTurnsAboutItsKeyframeNotAboutTheOrigin) {
  const Corrections corrections({{0.0, at(100.0), at(100.0)}, {1.0, at(101.0), at(101.0, 0.2)}});
  const Pose corrected = corrections.corrected({0.5, at(100.5)});
  EXPECT_LT((corrected.translation() - Eigen::Vector3d(100.5, 0, 0)).norm(), 0.06);
  EXPECT_NEAR(rotationAngle(corrected), 0.1, 1e-9);
}

}  // namespace
}  // namespace depth_fusion
