#include "acquisition/device_clock.h"

#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

constexpr int kWindow = 300;
constexpr double kJump_s = 1.0;

}  // namespace

double DeviceClock::toHost(double device_s, double host_s) {
  const double difference_s = host_s - device_s;
  if (!started_ || std::abs(difference_s - difference_s_) > kJump_s) {
    started_ = true;
    difference_s_ = next_difference_s_ = difference_s;
    images_ = 0;
  }
  difference_s_ = std::min(difference_s_, difference_s);
  next_difference_s_ = images_ == 0 ? difference_s : std::min(next_difference_s_, difference_s);
  if (++images_ == kWindow) {
    difference_s_ = next_difference_s_;
    images_ = 0;
  }
  return device_s + difference_s_;
}

}  // namespace depth_fusion
