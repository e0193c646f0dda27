#include "ros/input/rgbd_pairing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

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
  color_has_come_ = true;
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
  const auto later_s = [&](const Color& color) { return secondsBetween(taken->header.stamp, color.stamp); };
  const Color* color = nearest(colors_, std::numeric_limits<double>::max(),
                               [&](const Color& candidate) { return std::abs(later_s(candidate)); });
  const bool has_come = std::exchange(color_has_come_, false);
  if (color != nullptr && std::abs(later_s(*color)) <= parameters_.max_gap_s) {
    taken->color = color->image;
    unpaired_.notePaired();
  } else {  // a camera that is silent has no wrong clock
    const auto gap_s = color != nullptr && has_come ? std::optional<double>(later_s(*color)) : std::nullopt;
    taken->color_problem = unpaired_.noteUnpaired(gap_s, parameters_.max_gap_s);
  }
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
