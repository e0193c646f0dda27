// How many matches count as one measurement is told by the scatter of the gradients.
#include "icp_tracking/icp_system.h"

#include <gtest/gtest.h>

#include <random>

#include "shared/types.h"

namespace depth_fusion {
namespace {

constexpr int kRows = 240, kMatches = 60;  // in a row

// The sums of matches with the sensor's sigma, `alike` of which in a row share their error.
std::vector<float> sumsOfMatches(int alike) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<float> sums(kRows * ICP_SUMS, 0.0f);
  for (int row = 0; row < kRows; ++row) {
    double residual = 0.0;
    const Vector6d usual = Vector6d::NullaryExpr([&] { return normal(random); });
    for (int i = 0; i < kMatches; ++i) {
      if (i % alike == 0) residual = ICP_UNIT_SIGMA_M * normal(random);
      const Vector6d jacobian = usual + 0.1 * Vector6d::NullaryExpr([&] { return normal(random); });
      float* sum = &sums[row * ICP_SUMS];
      for (int a = 0; a < 6; ++a) {
        for (int b = a; b < 6; ++b) *sum++ += static_cast<float>(jacobian(a) * jacobian(b));
      }
      for (int a = 0; a < 6; ++a) *sum++ += static_cast<float>(jacobian(a) * residual);
    }
  }
  return sums;
}

TEST(IcpSystem, MatchesWithErrorsOfTheirOwnCountAsThemselves) {
  EXPECT_NEAR(sumRows(sumsOfMatches(1), 1).correlated(), 1.0, 0.3);
}

TEST(IcpSystem, MatchesThatShareTheirErrorsCountAsOne) {
  EXPECT_NEAR(sumRows(sumsOfMatches(12), 1).correlated(), 12.0, 3.6);
  EXPECT_NEAR(sumRows(sumsOfMatches(60), 1).correlated(), 60.0, 18.0);
}

// A row of two stands for the other, and is as sure as one.
TEST(IcpSystem, RowsThatAreLeftOutSayNothing) {
  const std::vector<float> sums = sumsOfMatches(12);
  EXPECT_NEAR(sumRows(sums, 2).correlated(), 2.0 * sumRows(sums, 1).correlated(), 1e-6);
}

}  // namespace
}  // namespace depth_fusion
