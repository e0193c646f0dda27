#include "depth_fusion/pipeline/motion_model.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

constexpr double kPeriod_s = 0.1;

Pose at(double x_m) {
  Pose pose = Pose::Identity();
  pose.translation().x() = x_m;
  return pose;
}

FrameMotion motion(const std::string& origin, double x_m) { return {origin, at(x_m), Matrix6d::Identity()}; }

void expectPrior(const MotionPrior& prior, const std::string& origin, double x_m) {
  EXPECT_EQ(prior.origin, origin);
  EXPECT_NEAR(prior.T_W_D.translation().x(), x_m, 1e-12);
  EXPECT_EQ(prior.covariance.has_value(), origin != "last pose");
}

FrameMotion sureMotion(const std::string& origin, double x_m, double sigma) {
  return {origin, at(x_m), sigma * sigma * Matrix6d::Identity()};
}

TEST(MotionModel, MotionsThatAgreeAreThePriorTogether) {
  MotionModel model;
  model.moveTo(0.0, at(1.0));
  const MotionPrior prior =
      model.predict(kPeriod_s, {sureMotion("texture", 0.02, 0.01), sureMotion("odometry", 0.05, 0.02)});
  expectPrior(prior, "texture, odometry", 1.026);
  EXPECT_NEAR((*prior.covariance)(3, 3), 0.8e-4, 1e-12);
  EXPECT_NEAR(model.velocity()[3], 0.026 / kPeriod_s, 1e-12);
  EXPECT_EQ(model.otherStarts().front().origin, "last pose");
}

TEST(MotionModel, AMotionThatContradictsTheFirstIsAnotherStart) {
  MotionModel model;
  model.moveTo(0.0, at(1.0));
  expectPrior(
      model.predict(kPeriod_s, {sureMotion("texture", 0.02, 0.001), sureMotion("odometry", 0.05, 0.001)}),
      "texture", 1.02);
  expectPrior(model.otherStarts().front(), "odometry", 1.05);
  ASSERT_EQ(model.measured().size(), 2u);
  expectPrior(model.measured()[1], "odometry", 1.05);
}

TEST(MotionModel, ALostSensorsPoseGoesOnWithAGrowingCovariance) {
  MotionModel model;
  model.moveTo(0.0, at(1.0));
  EXPECT_FALSE(model.bridged());
  model.lose();
  double before = 0.0;
  for (int i = 1; i <= 4; ++i) {
    const MotionPrior prior = model.predict(i * kPeriod_s, {sureMotion("odometry", 0.1, 0.01)});
    ASSERT_TRUE(model.bridged());
    EXPECT_NEAR(model.bridged()->T_W_D.translation().x(), 1.0 + 0.1 * i, 1e-12);
    EXPECT_NEAR((*prior.covariance)(3, 3), i * 1e-4, 1e-12);
    EXPECT_GT((*prior.covariance)(4, 4), before) << "the heading's error moves it aside";
    before = (*prior.covariance)(4, 4);
  }
  model.predict(5 * kPeriod_s, {});
  EXPECT_FALSE(model.bridged()) << "a motion is missing";
}

// What misleads depth misleads texture, too.
TEST(MotionModel, ALostSensorsPoseDoesNotGoOnByTextureAlone) {
  MotionModel model;
  model.moveTo(0.0, at(1.0));
  model.lose();
  model.predict(kPeriod_s, {sureMotion("texture", 0.1, 0.01)});
  EXPECT_FALSE(model.bridged());
}

TEST(MotionModel, WithoutAMotionItIsTheLastPose) {
  MotionModel model;
  expectPrior(model.predict(0.0, {}), "last pose", 0.0);
  model.moveTo(0.0, at(1.0));
  expectPrior(model.predict(kPeriod_s, {}), "last pose", 1.0);
}

TEST(MotionModel, KnownPosesGiveTheVelocity) {
  MotionModel model;
  EXPECT_TRUE(model.moveTo(0.0, at(1.0)).isZero()) << "nothing is known before";
  EXPECT_NEAR(model.moveTo(kPeriod_s, at(1.03))[3], 0.3, 1e-12);
  model.predict(2 * kPeriod_s, {});
  EXPECT_NEAR(model.velocity()[3], 0.3, 1e-12) << "the sensor is taken to go on";
  EXPECT_TRUE(model.moveTo(kPeriod_s + 1.0, at(1.5)).isZero()) << "a second says nothing about now";
}

TEST(MotionModel, MotionsCountWhileTheSensorIsLost) {
  MotionModel model;
  model.moveTo(0.0, at(1.0));
  model.predict(kPeriod_s, {motion("texture", 0.1)});
  model.lose();
  EXPECT_FALSE(model.isTracking());
  expectPrior(model.predict(2 * kPeriod_s, {}), "last pose", 1.1);
  EXPECT_TRUE(model.velocity().isZero());
  expectPrior(model.predict(3 * kPeriod_s, {motion("texture", 0.1)}), "texture", 1.2);
  model.loseAt(at(5.0));
  expectPrior(model.predict(4 * kPeriod_s, {}), "last pose", 5.0);
}

}  // namespace
}  // namespace depth_fusion
