// Stamps that jump, and the times that images get.
#include "ros/bags/bag_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace depth_fusion {
namespace {

constexpr double kStart_s = 1000.0;
constexpr double kPeriod_s = 1.0 / 30.0;
constexpr int kImages = 30;

double receivedAt(int i) { return kStart_s + kPeriod_s * i; }

// The times of a camera's images, whose stamps are off by off_s(i) from a clock lead_s ahead of the receipt;
// -1 for those left out.
template <class Offset>
std::vector<double> timesOf(const Offset& off_s, double lead_s = 0.0) {
  BagClock clock(lead_s);
  std::vector<double> times_s;
  for (int i = 0; i < kImages; ++i)
    times_s.push_back(clock.timeOf(receivedAt(i) + lead_s + off_s(i), receivedAt(i)).value_or(-1.0));
  return times_s;
}

int leftOut(const std::vector<double>& times_s) {
  return static_cast<int>(std::count(times_s.begin(), times_s.end(), -1.0));
}

// Each is later than the one before, and where it would be had nothing jumped, up to a period.
void expectGoesOn(const std::vector<double>& times_s, double lead_s = 0.0) {
  double last_s = 0.0;
  for (int i = 0; i < kImages; ++i) {
    const double time_s = times_s[static_cast<size_t>(i)];
    if (time_s < 0.0) continue;
    EXPECT_GT(time_s, last_s) << i;
    EXPECT_NEAR(time_s, receivedAt(i) + lead_s, kPeriod_s + 1e-6) << i;
    last_s = time_s;
  }
}

TEST(BagClock, stamps_that_go_on_are_the_times) {
  for (const double lead_s : {0.0, -0.4, 86400.0}) {
    const auto times_s = timesOf([](int) { return 0.0; }, lead_s);
    for (int i = 0; i < kImages; ++i) EXPECT_EQ(times_s[static_cast<size_t>(i)], receivedAt(i) + lead_s);
  }
}

TEST(BagClock, one_image_ahead_costs_none) {
  for (const double ahead_s : {0.3, 1.0, 3600.0, 1e9}) {
    for (const int odd : {0, 1, 7, kImages - 1}) {
      const auto times_s = timesOf([&](int i) { return i == odd ? ahead_s : 0.0; }, 0.05);
      EXPECT_EQ(leftOut(times_s), 0) << ahead_s << " s, image " << odd;
      expectGoesOn(times_s, 0.05);
    }
  }
}

TEST(BagClock, a_clock_that_is_set_goes_on) {
  for (const double step_s : {-3600.0, -5.0, -0.15, 0.3, 5.0, 3600.0}) {
    for (const int first : {1, 2, 15}) {
      const auto times_s = timesOf([&](int i) { return i < first ? 0.0 : step_s; });
      EXPECT_LE(leftOut(times_s), 1) << step_s << " s at image " << first;
      expectGoesOn(times_s);
    }
  }
}

TEST(BagClock, stamps_that_stand_still_cost_none) {
  const auto still_s = [](int i) { return kStart_s - receivedAt(i); };
  EXPECT_EQ(leftOut(timesOf(still_s)), 0);
  expectGoesOn(timesOf(still_s));
  const auto in_pairs_s = [](int i) { return receivedAt(i - i % 2) - receivedAt(i); };
  EXPECT_EQ(leftOut(timesOf(in_pairs_s)), 0);
  expectGoesOn(timesOf(in_pairs_s));
}

TEST(BagClock, an_image_out_of_order_is_left_out_alone) {
  const auto times_s = timesOf([](int i) { return i == 7 ? -2.5 * kPeriod_s : 0.0; });
  EXPECT_EQ(leftOut(times_s), 1);
  EXPECT_EQ(times_s[7], -1.0);
  expectGoesOn(times_s);
}

TEST(BagClock, receipts_that_come_in_a_burst_change_nothing) {
  BagClock clock(0.0);
  for (int i = 0; i < kImages; ++i) {
    const double received_s = i < 10 ? receivedAt(i) : receivedAt(i) + 3.0;
    EXPECT_EQ(clock.timeOf(receivedAt(i), received_s), receivedAt(i)) << i;
  }
}

TEST(BagClock, times_grow_even_if_neither_stamps_nor_receipts_do) {
  BagClock clock(0.0);
  double last_s = 0.0;
  for (int i = 0; i < kImages; ++i) {
    const auto time_s = clock.timeOf(5.0, 5.0);
    ASSERT_TRUE(time_s.has_value());
    EXPECT_GT(*time_s, last_s);
    last_s = *time_s;
  }
}

}  // namespace
}  // namespace depth_fusion
