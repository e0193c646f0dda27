// What closed loops make of poses that were tracked before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

struct CorrectedKeyframe {
  double stamp_s = 0.0;
  Pose T_W_then = Pose::Identity();  // as it was tracked
  Pose T_W_now = Pose::Identity();
  // Keyframes of a stretch were tracked in one go; stretches that loops hold together are one part. Both have
  // the number of the first keyframe in them.
  uint32_t stretch = 0, part = 0;
};

class Corrections {
 public:
  Corrections() = default;
  // The keyframes in any order.
  explicit Corrections(std::vector<CorrectedKeyframe> keyframes);

  // A pose as it was tracked: what the keyframes before and after make of it, blended by time; the one before
  // alone where they are of two stretches.
  Pose corrected(const StampedPose& tracked) const;
  // The part that a frame of that time is of.
  uint32_t partAt(double stamp_s) const;
  // Whether nothing says how the last keyframe lies to other parts. One of a single keyframe, after which the
  // sensor was lost again, does not count.
  bool isApart() const;
  // How far the keyframe is moved that is moved most.
  double largestMove_m() const;

  // As they were given.
  const std::vector<CorrectedKeyframe>& keyframes() const { return keyframes_; }

 private:
  // Returns the last keyframe until then, or the first of all, and the one after it by time, if there is one.
  // There are keyframes.
  std::pair<const CorrectedKeyframe*, const CorrectedKeyframe*> about(double stamp_s) const;

  std::vector<CorrectedKeyframe> keyframes_;
  std::vector<size_t> by_time_;  // their indices
};

}  // namespace depth_fusion
