#include "ros/input/stamp_policy.h"

namespace depth_fusion {
namespace {

// Stamps that go back by less are images out of order, by more a clock that was set back.
constexpr double kClockJump_s = 1.0;

}  // namespace

ros::Time stampOrArrival(const ros::Time& stamp, const ros::Time& arrival) {
  return stamp.isZero() ? arrival : stamp;
}

StampPolicy::Verdict StampPolicy::judge(const ros::Time& stamp, const ros::Time& arrival) {
  Verdict verdict;
  verdict.stamp = stampOrArrival(stamp, arrival);
  if (last_ && verdict.stamp <= *last_) {
    verdict.back_s = (*last_ - verdict.stamp).toSec();
    verdict.order = verdict.back_s < kClockJump_s ? Order::kOutOfOrder : Order::kClockJump;
  }
  if (verdict.order == Order::kClockJump) ++clock_jumps_;
  if (verdict.order != Order::kOutOfOrder) last_ = verdict.stamp;
  verdict.clock_jumps = clock_jumps_;
  return verdict;
}

}  // namespace depth_fusion
