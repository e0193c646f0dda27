#include "ros/bags/bag_clock.h"

#include <cmath>

namespace depth_fusion {
namespace {

constexpr double kJump_s = 0.2;
constexpr double kFramePeriod_s = 1.0 / 30.0;  // where neither stamps nor receipts tell any

}  // namespace

std::optional<double> BagClock::timeOf(double stamp_s, double received_s) {
  const bool stands_still = last_stamp_s_ && stamp_s == *last_stamp_s_;
  last_stamp_s_ = stamp_s;
  std::optional<double> time_s;
  if (!stands_still) time_s = timeByStamp(stamp_s, received_s);
  if (!time_s) {
    const bool leave_out = !stands_still && isLittleBehind(stamp_s) && !was_behind_;
    was_behind_ = leave_out;
    if (leave_out) return std::nullopt;
    time_s = timeByReceipt(received_s);
    if (!stands_still) shift_s_ = *time_s - stamp_s;
  }
  was_behind_ = false;
  last_time_s_ = time_s;
  lead_s_ = *time_s - received_s;
  return time_s;
}

// The stamp as it is or, if it does not go on from the last time, moved as those before it.
std::optional<double> BagClock::timeByStamp(double stamp_s, double received_s) const {
  for (const double time_s : {stamp_s, stamp_s + shift_s_}) {
    const bool is_later = !last_time_s_ || time_s > *last_time_s_;
    const bool goes_on = last_time_s_ && time_s - *last_time_s_ < kJump_s;
    const bool fits_receipt = std::abs(time_s - (received_s + lead_s_)) < kJump_s;
    if (is_later && (goes_on || fits_receipt)) return time_s;
  }
  return std::nullopt;
}

double BagClock::timeByReceipt(double received_s) const {
  const double time_s = received_s + lead_s_;
  return !last_time_s_ || time_s > *last_time_s_ ? time_s : *last_time_s_ + kFramePeriod_s;
}

bool BagClock::isLittleBehind(double stamp_s) const {
  const auto is_behind = [this](double time_s) {
    return last_time_s_ && time_s <= *last_time_s_ && *last_time_s_ - time_s < kJump_s;
  };
  return is_behind(stamp_s) || is_behind(stamp_s + shift_s_);
}

}  // namespace depth_fusion
