#include "depth_fusion/loops/corrections.h"

#include <algorithm>
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

Pose Corrections::corrected(const StampedPose& tracked) const {
  if (keyframes_.empty()) return tracked.T_W_D;
  const auto next =
      std::upper_bound(by_time_.begin(), by_time_.end(), tracked.stamp_s,
                       [this](double stamp_s, size_t i) { return stamp_s < keyframes_[i].stamp_s; });
  const CorrectedKeyframe& before = keyframes_[next == by_time_.begin() ? *next : *(next - 1)];
  const Pose by_before = carried(before, tracked.T_W_D);
  if (next == by_time_.begin() || next == by_time_.end()) return by_before;
  const CorrectedKeyframe& after = keyframes_[*next];
  return interpolate({before.stamp_s, by_before}, {after.stamp_s, carried(after, tracked.T_W_D)},
                     tracked.stamp_s);
}

double Corrections::largestMove_m() const {
  double largest_m = 0.0;
  for (const CorrectedKeyframe& keyframe : keyframes_)
    largest_m =
        std::max(largest_m, (keyframe.T_W_now.translation() - keyframe.T_W_then.translation()).norm());
  return largest_m;
}

}  // namespace depth_fusion
