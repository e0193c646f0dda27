#include "depth_fusion/loops/corrections.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace depth_fusion {
namespace {

Pose carried(const CorrectedKeyframe& keyframe, const Pose& T_W_D) {
  return orthonormalized(keyframe.T_W_now * keyframe.T_W_then.inverse() * T_W_D);
}

}  // namespace

Corrections::Corrections(std::vector<CorrectedKeyframe> keyframes)
    : keyframes_(std::move(keyframes)), by_time_(keyframes_.size()) {
  std::iota(by_time_.begin(), by_time_.end(), size_t{0});
  std::stable_sort(by_time_.begin(), by_time_.end(),
                   [this](size_t a, size_t b) { return keyframes_[a].stamp_s < keyframes_[b].stamp_s; });
}

std::pair<const CorrectedKeyframe*, const CorrectedKeyframe*> Corrections::about(double stamp_s) const {
  const auto next =
      std::upper_bound(by_time_.begin(), by_time_.end(), stamp_s,
                       [this](double stamp, size_t i) { return stamp < keyframes_[i].stamp_s; });
  if (next == by_time_.begin()) return {&keyframes_[*next], nullptr};
  return {&keyframes_[*(next - 1)], next == by_time_.end() ? nullptr : &keyframes_[*next]};
}

Pose Corrections::corrected(const StampedPose& tracked) const {
  if (keyframes_.empty()) return tracked.T_W_D;
  const auto [before, after] = about(tracked.stamp_s);
  const Pose by_before = carried(*before, tracked.T_W_D);
  if (after == nullptr || after->stretch != before->stretch) return by_before;
  return interpolate({before->stamp_s, by_before}, {after->stamp_s, carried(*after, tracked.T_W_D)},
                     tracked.stamp_s);
}

uint32_t Corrections::partAt(double stamp_s) const {
  return keyframes_.empty() ? 0 : about(stamp_s).first->part;
}

bool Corrections::isApart() const {
  std::map<uint32_t, size_t> parts;
  for (const CorrectedKeyframe& keyframe : keyframes_) ++parts[keyframe.part];
  return std::any_of(parts.begin(), parts.end(), [this](const auto& part) {
    return part.first != keyframes_.back().part && part.second > 1;
  });
}

double Corrections::largestMove_m() const {
  double largest_m = 0.0;
  for (const CorrectedKeyframe& keyframe : keyframes_)
    largest_m =
        std::max(largest_m, (keyframe.T_W_now.translation() - keyframe.T_W_then.translation()).norm());
  return largest_m;
}

}  // namespace depth_fusion
