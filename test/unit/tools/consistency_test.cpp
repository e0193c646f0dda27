#include "tools/evaluation/consistency.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

TEST(Consistency, CountsErrorsInStandardDeviations) {
  Vector6d error = Vector6d::Zero();
  error(2) = 0.02;
  error(4) = 0.3;
  const Vector6d variances = (Vector6d() << 1, 1, 1e-4, 1, 0.01, 1).finished();
  EXPECT_NEAR(nees(error, variances.asDiagonal()), 4.0 + 9.0, 1e-9);
}

// Quantiles of chi-square with 30 and 120 degrees of freedom, from tables.
TEST(Consistency, BoundsAreThoseOfChiSquare) {
  const NeesBounds five = neesBounds(5), twenty = neesBounds(20);
  EXPECT_NEAR(five.lower, 16.791 / 5, 0.01);
  EXPECT_NEAR(five.upper, 46.979 / 5, 0.01);
  EXPECT_NEAR(twenty.lower, 91.573 / 20, 0.01);
  EXPECT_NEAR(twenty.upper, 152.211 / 20, 0.01);
  EXPECT_TRUE(twenty.hold(6.0));
  EXPECT_FALSE(twenty.hold(4.5) || twenty.hold(7.7));
}

}  // namespace
}  // namespace depth_fusion
