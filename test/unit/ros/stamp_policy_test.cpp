// What becomes of images by their stamps alone.
#include "ros/input/stamp_policy.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

using Order = StampPolicy::Order;

const ros::Time kArrival(500.0);

class StampPolicyTest : public testing::Test {
 protected:
  StampPolicy::Verdict judge(double stamp_s) { return policy_.judge(ros::Time(stamp_s), kArrival); }
  Order orderOf(double stamp_s) { return judge(stamp_s).order; }

  StampPolicy policy_;
};

TEST_F(StampPolicyTest, LaterImagesAreNext) {
  for (const double stamp_s : {100.0, 100.033, 100.034, 200.0}) {
    const StampPolicy::Verdict verdict = judge(stamp_s);
    EXPECT_EQ(verdict.order, Order::kNext) << stamp_s;
    EXPECT_EQ(verdict.stamp, ros::Time(stamp_s));
    EXPECT_EQ(verdict.back_s, 0.0);
    EXPECT_EQ(verdict.clock_jumps, 0u);
  }
}

TEST_F(StampPolicyTest, EqualAndSlightlyEarlierStampsAreOutOfOrder) {
  judge(100.0);
  for (const double stamp_s : {100.0, 99.9, 99.25})
    EXPECT_EQ(orderOf(stamp_s), Order::kOutOfOrder) << stamp_s;
  EXPECT_EQ(orderOf(100.001), Order::kNext) << "those leave no trace";
  EXPECT_EQ(judge(100.002).clock_jumps, 0u);
}

TEST_F(StampPolicyTest, TheClockWasSetBackByASecondOrMore) {
  judge(100.0);
  const StampPolicy::Verdict verdict = judge(99.0);
  EXPECT_EQ(verdict.order, Order::kClockJump);
  EXPECT_EQ(verdict.back_s, 1.0);
  EXPECT_EQ(verdict.clock_jumps, 1u) << "the image is the first after the jump";
  EXPECT_EQ(orderOf(99.033), Order::kNext) << "time goes on from there";
  EXPECT_EQ(judge(50.0).clock_jumps, 2u);
  EXPECT_EQ(judge(50.033).clock_jumps, 2u);
}

TEST_F(StampPolicyTest, AnImageWithoutAStampGetsTheTimeOfItsArrival) {
  judge(100.0);
  const StampPolicy::Verdict verdict = judge(0.0);
  EXPECT_EQ(verdict.order, Order::kNext);
  EXPECT_EQ(verdict.stamp, kArrival);
  EXPECT_EQ(orderOf(0.0), Order::kOutOfOrder) << "it arrived at the same moment";
  EXPECT_EQ(stampOrArrival(ros::Time(), kArrival), kArrival);
  EXPECT_EQ(stampOrArrival(ros::Time(7.0), kArrival), ros::Time(7.0));
}

}  // namespace
}  // namespace depth_fusion
