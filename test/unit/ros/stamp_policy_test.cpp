// What becomes of images by their stamps and by when they came.
#include "ros/input/stamp_policy.h"

#include <gtest/gtest.h>

#include <vector>

namespace depth_fusion {
namespace {

using Order = StampPolicy::Order;

constexpr double kFrame_s = 0.033;
constexpr int kBelieved = 5;  // images in a row that agree

class StampPolicyTest : public testing::Test {
 protected:
  // The image comes a frame after the one before it.
  StampPolicy::Verdict judge(double stamp_s) { return judgeAt(arrival_s_ + kFrame_s, stamp_s); }
  StampPolicy::Verdict judgeAt(double arrival_s, double stamp_s) {
    arrival_s_ = arrival_s;
    return policy_.judge(ros::Time(stamp_s), ros::Time(arrival_s));
  }
  Order orderOf(double stamp_s) { return judge(stamp_s).order; }
  // Frames of a camera from that stamp on; returns what became of each.
  std::vector<Order> ordersFrom(double stamp_s, int count) {
    std::vector<Order> orders;
    for (int i = 0; i < count; ++i) orders.push_back(orderOf(stamp_s + i * kFrame_s));
    return orders;
  }
  static std::vector<Order> doubtfulThen(Order order) {
    std::vector<Order> orders(kBelieved - 1, Order::kDoubtful);
    orders.push_back(order);
    return orders;
  }

  StampPolicy policy_;
  double arrival_s_ = 500.0;
};

TEST_F(StampPolicyTest, LaterImagesAreNext) {
  for (const double stamp_s : {100.0, 100.033, 100.034, 100.9}) {
    const StampPolicy::Verdict verdict = judge(stamp_s);
    EXPECT_EQ(verdict.order, Order::kNext) << stamp_s;
    EXPECT_EQ(verdict.stamp, ros::Time(stamp_s));
    EXPECT_EQ(verdict.clock_jumps, 0u);
  }
}

TEST_F(StampPolicyTest, ASilentCameraGoesOn) {
  judge(100.0);
  EXPECT_EQ(judgeAt(arrival_s_ + 3600.0, 3700.0).order, Order::kNext);
}

TEST_F(StampPolicyTest, EqualAndSlightlyEarlierStampsAreOutOfOrder) {
  judge(100.0);
  for (const double stamp_s : {100.0, 99.9, 99.25})
    EXPECT_EQ(orderOf(stamp_s), Order::kOutOfOrder) << stamp_s;
  EXPECT_EQ(orderOf(100.001), Order::kNext) << "those leave no trace";
  EXPECT_EQ(judge(100.002).clock_jumps, 0u);
}

TEST_F(StampPolicyTest, OneWrongStampIsLeftOut) {
  for (const double wrong_s : {98.5, 50.0, 101.2, 101.5, 103.0, 5000.0, 4.2e9}) {
    StampPolicy policy;
    policy_ = policy;
    judge(100.0);
    EXPECT_EQ(orderOf(wrong_s), Order::kDoubtful) << wrong_s;
    const StampPolicy::Verdict next = judge(100.0 + 2 * kFrame_s);
    EXPECT_EQ(next.order, Order::kNext) << wrong_s;
    EXPECT_EQ(next.clock_jumps, 0u);
  }
}

TEST_F(StampPolicyTest, WrongStampsNowAndThenAreNeverBelieved) {
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(orderOf(100.0 + 2 * i * kFrame_s), Order::kNext) << i;
    EXPECT_EQ(judge(60.0 + 2 * i * kFrame_s).order, Order::kDoubtful) << i;
  }
}

TEST_F(StampPolicyTest, AClockSetBackIsBelievedOnceImagesAgree) {
  judge(100.0);
  EXPECT_EQ(ordersFrom(50.0, kBelieved), doubtfulThen(Order::kClockJump));
  const StampPolicy::Verdict next = judge(50.0 + kBelieved * kFrame_s);
  EXPECT_EQ(next.order, Order::kNext) << "time goes on from there";
  EXPECT_EQ(next.clock_jumps, 1u);
  EXPECT_EQ(ordersFrom(20.0, kBelieved).back(), Order::kClockJump);
}

TEST_F(StampPolicyTest, AClockSetBackIsBelievedAtOnceIfRosTimeWentBackToo) {
  judgeAt(100.01, 100.0);
  const StampPolicy::Verdict verdict = judgeAt(50.02, 50.0);
  EXPECT_EQ(verdict.order, Order::kClockJump);
  EXPECT_EQ(verdict.off_s, -50.0);
  EXPECT_EQ(verdict.clock_jumps, 1u) << "the image is the first after the jump";
}

TEST_F(StampPolicyTest, AClockSetAheadIsNoJump) {
  judge(100.0);
  EXPECT_EQ(ordersFrom(200.0, kBelieved), doubtfulThen(Order::kNext));
  EXPECT_EQ(judge(201.0).clock_jumps, 0u);
}

TEST_F(StampPolicyTest, AnImageWithoutAStampGetsTheTimeOfItsArrival) {
  const StampPolicy::Verdict verdict = judge(0.0);
  EXPECT_EQ(verdict.order, Order::kNext);
  EXPECT_EQ(verdict.stamp, ros::Time(arrival_s_));
  EXPECT_EQ(judgeAt(arrival_s_, 0.0).order, Order::kOutOfOrder) << "it arrived at the same moment";
  EXPECT_EQ(stampOrArrival(ros::Time(), ros::Time(3.0)), ros::Time(3.0));
  EXPECT_EQ(stampOrArrival(ros::Time(7.0), ros::Time(3.0)), ros::Time(7.0));
}

TEST_F(StampPolicyTest, StampsThatStandStillAreNone) {
  constexpr int kManyImages = 40;
  int next = 0;
  for (int i = 0; i < kManyImages; ++i) next += orderOf(500.0) == Order::kNext;
  EXPECT_GE(next, kManyImages - 2 * kBelieved);
  const ros::Time stamp = judge(500.0).stamp;
  EXPECT_EQ(stamp, ros::Time(arrival_s_));
}

}  // namespace
}  // namespace depth_fusion
