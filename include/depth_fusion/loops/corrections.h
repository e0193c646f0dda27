// What closed loops make of poses that were tracked before.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

struct CorrectedKeyframe {
  double stamp_s = 0.0;
  Pose T_W_then = Pose::Identity();  // as it was tracked
  Pose T_W_now = Pose::Identity();
};

class Corrections {
 public:
  Corrections() = default;
  // The keyframes in any order.
  explicit Corrections(std::vector<CorrectedKeyframe> keyframes);

  // A pose as it was tracked: what the keyframes before and after make of it, blended by time.
  Pose corrected(const StampedPose& tracked) const;
  // How far the keyframe is moved that is moved most.
  double largestMove_m() const;

  // As they were given.
  const std::vector<CorrectedKeyframe>& keyframes() const { return keyframes_; }

 private:
  std::vector<CorrectedKeyframe> keyframes_;
  std::vector<size_t> by_time_;  // their indices
};

}  // namespace depth_fusion
