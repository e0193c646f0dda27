#include "ros/input/stamp_policy.h"

#include <cmath>

#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

// Stamps that go back by less are images out of order, by more perhaps a clock that was set back.
constexpr double kClockJump_s = 1.0;
// An image that is later by more than it came later is perhaps one of a wrong stamp. It is less than a jump,
// so that one such image that is taken does not make those after it look like a clock that was set back.
constexpr double kAhead_s = 0.9;
constexpr int kMany = 5;  // images that agree are believed

}  // namespace

ros::Time stampOrArrival(const ros::Time& stamp, const ros::Time& arrival) {
  return stamp.isZero() ? arrival : stamp;
}

StampPolicy::Verdict StampPolicy::judge(const ros::Time& stamp, const ros::Time& arrival) {
  const Image image{usedStamp(stamp, arrival), arrival};
  Verdict verdict = last_ ? judgeAfter(*last_, image) : Verdict();
  verdict.stamp = image.stamp;
  if (verdict.order == Order::kClockJump) ++clock_jumps_;
  if (verdict.order == Order::kNext || verdict.order == Order::kClockJump) {
    last_ = image;
    doubtful_.in_a_row = 0;
  }
  verdict.clock_jumps = clock_jumps_;
  return verdict;
}

StampPolicy::Verdict StampPolicy::judgeAfter(const Image& before, const Image& image) {
  const double later_s = secondsBetween(before.stamp, image.stamp);
  const double came_later_s = secondsBetween(before.arrival, image.arrival);
  const bool is_back = later_s <= -kClockJump_s;
  const bool is_ros_time = std::abs(secondsBetween(image.arrival, image.stamp)) < kClockJump_s;
  Verdict verdict;
  if (!is_back && (is_ros_time || later_s < came_later_s + kAhead_s)) {
    if (later_s <= 0.0) verdict.order = Order::kOutOfOrder;
    return verdict;
  }
  verdict.off_s = later_s;
  if (std::abs(later_s - came_later_s) < kClockJump_s) {
    verdict.reason = "and so did ROS time";
  } else if (areMany(image)) {
    verdict.reason = "and the images after it agree";
  } else {
    verdict.order = Order::kDoubtful;
    return verdict;
  }
  if (is_back) verdict.order = Order::kClockJump;
  return verdict;
}

ros::Time StampPolicy::usedStamp(const ros::Time& stamp, const ros::Time& arrival) {
  same_in_a_row_ = stamp == same_ ? same_in_a_row_ + 1 : 1;
  same_ = stamp;
  return stampOrArrival(same_in_a_row_ > kMany ? ros::Time() : stamp, arrival);
}

bool StampPolicy::areMany(const Image& image) {
  const double later_s = secondsBetween(doubtful_.last.stamp, image.stamp);
  const double came_later_s = secondsBetween(doubtful_.last.arrival, image.arrival);
  const bool goes_on = doubtful_.in_a_row > 0 && later_s > 0.0 && later_s < came_later_s + kClockJump_s;
  doubtful_ = {image, goes_on ? doubtful_.in_a_row + 1 : 1};
  return doubtful_.in_a_row >= kMany;
}

}  // namespace depth_fusion
