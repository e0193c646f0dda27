#include "ros/input/rgbd_pairing.h"

#include <algorithm>
#include <cmath>

#include "common/nearest.h"
#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

constexpr size_t kColorsKept = 30;
constexpr double kFuture_s = 1.0;  // colour this much later than a clock set back is from before

}  // namespace

void RgbdPairing::addDepth(const std::shared_ptr<RgbdMessages>& depth) { waiting_.push_back(depth); }

void RgbdPairing::addColor(const ros::Time& stamp, const ImageMessage& image) {
  colors_.push_back({stamp, image});
  if (colors_.size() > kColorsKept) colors_.pop_front();
}

bool RgbdPairing::firstIsComplete(const ros::WallTime& now, bool color_comes) const {
  if (!color_comes && colors_.empty()) return true;
  const ros::Time& stamp = first()->header.stamp;
  return std::any_of(colors_.begin(), colors_.end(),
                     [&](const Color& color) {
                       const double later_s = secondsBetween(stamp, color.stamp);
                       return later_s >= 0.0 && later_s < kFuture_s;
                     }) ||
         waited_s(now) > parameters_.max_wait_s;
}

RgbdMessagesPtr RgbdPairing::takeFirst() {
  const std::shared_ptr<RgbdMessages> taken = waiting_.front();
  waiting_.pop_front();
  const Color* color = nearest(colors_, parameters_.max_gap_s, [&](const Color& candidate) {
    return std::abs(secondsBetween(taken->header.stamp, candidate.stamp));
  });
  if (color != nullptr) taken->color = color->image;
  return taken;
}

size_t RgbdPairing::restart(const ros::Time& stamp) {
  const size_t forgotten = waiting_.size();
  waiting_.clear();
  colors_.erase(
      std::remove_if(colors_.begin(), colors_.end(),
                     [&](const Color& color) { return secondsBetween(stamp, color.stamp) > kFuture_s; }),
      colors_.end());
  return forgotten;
}

}  // namespace depth_fusion
