#include "depth_fusion/common/percentile.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

TEST(Percentile, IsTheNearestRank) {
  const std::vector<double> samples = {50, 15, 40, 20, 35};
  EXPECT_EQ(percentile(samples, 0.0), 15);
  EXPECT_EQ(percentile(samples, 0.05), 15);
  EXPECT_EQ(percentile(samples, 0.30), 20);
  EXPECT_EQ(percentile(samples, 0.40), 20);
  EXPECT_EQ(percentile(samples, 0.50), 35);
  EXPECT_EQ(percentile(samples, 1.0), 50);
}

TEST(Percentile, OfNothingIsZero) { EXPECT_EQ(percentile({}, 0.5), 0.0); }

}  // namespace
}  // namespace depth_fusion
