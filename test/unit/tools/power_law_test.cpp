#include "tools/evaluation/power_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

TEST(PowerLaw, ExponentOfConstantLineAndSquare) {
  EXPECT_NEAR(powerLawExponent({{1, 7}, {10, 7}, {50, 7}}), 0.0, 1e-12);
  EXPECT_NEAR(powerLawExponent({{1, 3}, {2, 6}, {50, 150}}), 1.0, 1e-12);
  EXPECT_NEAR(powerLawExponent({{0.1, 0.02}, {2, 8}, {30, 1800}}), 2.0, 1e-12);
}

TEST(PowerLaw, FitsTheLogarithmsByLeastSquares) {
  // Logarithms (0, 0), (1, 2), (2, 1): about their mean (1, 1), x * y sums to 1 and x * x to 2.
  const double e = std::exp(1.0);
  EXPECT_NEAR(powerLawExponent({{1, 1}, {e, e * e}, {e * e, e}}), 0.5, 1e-12);
}

TEST(PowerLaw, NeedsTwoDifferentPositiveX) {
  EXPECT_THROW(powerLawExponent({}), Error);
  EXPECT_THROW(powerLawExponent({{2, 1}, {2, 3}}), Error);
  EXPECT_THROW(powerLawExponent({{0, 1}, {2, 3}}), Error);
}

}  // namespace
}  // namespace depth_fusion
