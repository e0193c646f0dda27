#include "depth_fusion/loops/corrections.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

Pose at(double x_m, double turn_rad = 0.0) {
  Pose pose(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()));
  pose.translation().x() = x_m;
  return pose;
}

TEST(Corrections, BlendByWayBetweenKeyframes) {
  const Corrections corrections({{0.0, at(0.0), at(0.0)}, {2.0, at(2.0), at(2.2)}, {3.0, at(3.0), at(3.2)}});
  EXPECT_NEAR(corrections.corrected(at(0.5), 0.5).translation().x(), 0.55, 1e-12);
  EXPECT_NEAR(corrections.corrected(at(2.0), 2.0).translation().x(), 2.2, 1e-12);
  EXPECT_NEAR(corrections.corrected(at(2.5), 2.5).translation().x(), 2.7, 1e-12);
  EXPECT_NEAR(corrections.corrected(at(9.0), 9.0).translation().x(), 9.2, 1e-12) << "after the last";
  EXPECT_NEAR(corrections.corrected(at(-1.0), -1.0).translation().x(), -1.0, 1e-12) << "before the first";
  EXPECT_TRUE(Corrections().corrected(at(1.0), 1.0).isApprox(at(1.0)));
}

TEST(Corrections, AFrameTurnsAboutItsKeyframeNotAboutTheOrigin) {
  const Corrections corrections({{0.0, at(100.0), at(100.0)}, {1.0, at(101.0), at(101.0, 0.2)}});
  const Pose corrected = corrections.corrected(at(100.5), 0.5);
  EXPECT_LT((corrected.translation() - Eigen::Vector3d(100.5, 0, 0)).norm(), 0.06);
  EXPECT_NEAR(rotationAngle(corrected), 0.1, 1e-9);
}

TEST(Corrections, ASubmapMovesAsItsKeyframesDoInTheMean) {
  const Pose motion = [] {
    Pose pose(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
    pose.translation() = Eigen::Vector3d(0.1, -0.2, 0.3);
    return pose;
  }();
  const Corrections corrections({{0.0, at(5.0), motion * at(5.0)},
                                 {1.0, at(6.0, 0.4), motion * at(6.0, 0.4)},
                                 {2.0, at(7.0), at(7.0)}});
  EXPECT_LT((corrections.meanMotion({0, 1}).matrix() - motion.matrix()).norm(), 1e-9);
  EXPECT_TRUE(corrections.meanMotion({2}).isApprox(Pose::Identity()));
  EXPECT_TRUE(corrections.meanMotion({}).isApprox(Pose::Identity()));
}

}  // namespace
}  // namespace depth_fusion
