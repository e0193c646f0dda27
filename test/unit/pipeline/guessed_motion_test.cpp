#include "depth_fusion/pipeline/guessed_motion.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;

Vector6d moving(double m_s, double rad_s = 0.0) {
  return (Vector6d() << rad_s, 0.0, 0.0, 0.0, 0.0, m_s).finished();
}

// How many frames in a row are guessed, of which so much is measured, until the pose may be wrong.
int framesUntilTooFar(const Vector6d& before, const Vector6d& measured) {
  GuessedMotion motion;
  motion.measure(0.0, before);
  int frames = 0;
  while (!motion.isTooFar()) motion.guess(++frames * kFrame_s, measured);
  return frames;
}

TEST(GuessedMotion, IsBridgedForASecondByASensorThatStandsStill) {
  EXPECT_NEAR(framesUntilTooFar(moving(0.003), moving(0.002)), 30, 2);
}

TEST(GuessedMotion, EndsSoonWhereTheSensorWasFast) {
  EXPECT_EQ(framesUntilTooFar(moving(0.6), moving(0.0)), 3);
  EXPECT_EQ(framesUntilTooFar(moving(0.003), moving(0.6)), 3) << "or gets fast";
  EXPECT_EQ(framesUntilTooFar(moving(0.003, 1.0), moving(0.0)), 2) << "or turned";
}

TEST(GuessedMotion, EndsSoonWhereNothingIsKnown) {
  EXPECT_NEAR(framesUntilTooFar(moving(0.0), moving(0.0)), 5, 1);
}

TEST(GuessedMotion, IsOverWhereAFrameIsMeasured) {
  GuessedMotion motion;
  motion.measure(0.0, moving(0.6));
  motion.guess(0.07, moving(0.0));
  EXPECT_NEAR(motion.m(), 0.042, 1e-12);
  motion.measure(0.14, moving(0.3));
  EXPECT_EQ(motion.m(), 0.0);
  motion.guess(0.24, moving(0.0));
  EXPECT_NEAR(motion.m(), 0.03, 1e-12);
}

TEST(GuessedMotion, EndsAnywhere) {
  GuessedMotion motion;
  motion.measure(0.0, moving(0.6));
  motion.guess(0.5, moving(0.0));
  EXPECT_TRUE(motion.isTooFar());
  EXPECT_FALSE(motion.isAnywhere());
  motion.guess(1.0, moving(0.0));
  EXPECT_TRUE(motion.isAnywhere());
}

}  // namespace
}  // namespace depth_fusion
