// What closed loops make of poses that were tracked before.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

struct CorrectedKeyframe {
  double way_m = 0.0;                // that the sensor had gone
  Pose T_W_then = Pose::Identity();  // as it was tracked
  Pose T_W_now = Pose::Identity();
};

class Corrections {
 public:
  Corrections() = default;
  // In the order of their way.
  explicit Corrections(std::vector<CorrectedKeyframe> keyframes) : keyframes_(std::move(keyframes)) {}

  // A pose that was tracked after so much way: what the keyframes before and after make of it, blended by
  // way.
  Pose corrected(const Pose& T_W_D, double way_m) const;
  // The one rigid motion of W that fits the keyframes of these indices best, of a submap for instance: the
  // mean of theirs about their middle. The identity for none.
  Pose meanMotion(const std::vector<uint32_t>& indices) const;

  const std::vector<CorrectedKeyframe>& keyframes() const { return keyframes_; }

 private:
  std::vector<CorrectedKeyframe> keyframes_;
};

}  // namespace depth_fusion
