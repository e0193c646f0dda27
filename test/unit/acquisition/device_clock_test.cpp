#include "acquisition/device_clock.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

constexpr double kPeriod_s = 1.0 / 32.0;  // sums of it are exact
constexpr double kExact_s = 1e-9;

// Images of a device whose clock is behind the host's, each with its delay on the way.
class DeviceClockTest : public testing::Test {
 protected:
  // The error of the host's time that the clock gives the next image.
  double next(double delay_s) {
    taken_s_ += kPeriod_s;
    return clock_.toHost(taken_s_ / rate_ - offset_s_, taken_s_ + delay_s) - taken_s_;
  }

  DeviceClock clock_;
  double taken_s_ = 1000.0;  // by the host's clock
  double offset_s_ = 990.0;
  double rate_ = 1.0;  // of the host's clock against the device's
};

TEST_F(DeviceClockTest, TheFirstImageHasItsArrival) { EXPECT_NEAR(next(0.04), 0.04, kExact_s); }

TEST_F(DeviceClockTest, TheQuickestImageTellsTheDelayOfAll) {
  next(0.04);
  EXPECT_NEAR(next(0.07), 0.04, kExact_s) << "as late as the quickest so far";
  EXPECT_NEAR(next(0.01), 0.01, kExact_s);
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(next(0.02 + 0.001 * i), 0.01, kExact_s);
}

TEST_F(DeviceClockTest, OneQuickImageAmongMostlySlowOnesIsForgottenInTheEnd) {
  next(0.01);
  double error_s = 0.0;
  for (int i = 0; i < 600; ++i) error_s = next(0.03);
  EXPECT_NEAR(error_s, 0.03, kExact_s);
}

TEST_F(DeviceClockTest, FollowsAClockThatRunsSlow) {
  rate_ = 1.0001;  // loses a millisecond in 320 images, about the length of the memory
  offset_s_ = 10.0;
  for (int i = 0; i < 5000; ++i) {
    const double error_s = next(i % 10 == 0 ? 0.005 : 0.03);
    EXPECT_GT(error_s, 0.005 - 0.002) << i;
    EXPECT_LT(error_s, 0.005 + 0.002) << i;
  }
}

TEST_F(DeviceClockTest, FollowsAClockThatRunsFast) {
  rate_ = 0.9999;
  offset_s_ = 10.0;
  for (int i = 0; i < 5000; ++i) {
    const double error_s = next(i % 10 == 0 ? 0.005 : 0.03);
    if (i < 10) continue;
    EXPECT_GT(error_s, 0.005 - 0.002) << i;
    EXPECT_LT(error_s, 0.005 + 0.002) << i;
  }
}

TEST_F(DeviceClockTest, BeginsAnewWhereTheDeviceClockIsSet) {
  for (int i = 0; i < 10; ++i) next(0.01);
  for (const double jump_s : {500.0, -700.0}) {
    offset_s_ += jump_s;
    EXPECT_NEAR(next(0.03), 0.03, kExact_s);
    EXPECT_NEAR(next(0.02), 0.02, kExact_s);
    EXPECT_NEAR(next(0.04), 0.02, kExact_s);
  }
}

TEST_F(DeviceClockTest, AnImageThatIsVeryLateSpoilsNoneAfterIt) {
  for (int i = 0; i < 10; ++i) next(0.01);
  next(3.0);
  EXPECT_NEAR(next(0.02), 0.02, kExact_s);
}

}  // namespace
}  // namespace depth_fusion
