#include "ros/input/mask_topic.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/nearest.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kTopicQueue = 10;
constexpr size_t kKept = 30;
constexpr double kFuture_s = 1.0;  // one this much later is from before the clock was set back

}  // namespace

MaskTopic::MaskTopic(ros::NodeHandle handle)
    : subscriber_(handle.subscribe<sensor_msgs::Image>("mask", kTopicQueue,
                                                       [this](const sensor_msgs::ImageConstPtr& mask) {
                                                         const std::lock_guard<std::mutex> lock(mutex_);
                                                         masks_.push_back(mask);
                                                         if (masks_.size() > kKept) masks_.pop_front();
                                                       })) {}

sensor_msgs::ImageConstPtr MaskTopic::find(const ros::Time& stamp, double max_gap_s) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto* found = nearest(masks_, max_gap_s, [&](const sensor_msgs::ImageConstPtr& mask) {
    return std::abs(secondsBetween(stamp, mask->header.stamp));
  });
  return found == nullptr ? nullptr : *found;
}

bool MaskTopic::isPast(const ros::Time& stamp) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::any_of(masks_.begin(), masks_.end(), [&](const sensor_msgs::ImageConstPtr& mask) {
    const double later_s = secondsBetween(stamp, mask->header.stamp);
    return later_s >= 0.0 && later_s < kFuture_s;
  });
}

}  // namespace depth_fusion
