// Preprocessing as a step of the pipeline: timed, with the sensor's velocity taken out.
#pragma once

#include "depth_fusion/common/stage_timers.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"

namespace depth_fusion {

// Of D in D, per second, by the motion over that time. Zero over a longer gap, which says nothing about how
// fast the sensor moves now.
inline Vector6d velocityOver(const Pose& T_before_now, double seconds) {
  constexpr double kMaxGap_s = 0.25;
  if (!(seconds > 0.0 && seconds < kMaxGap_s)) return Vector6d::Zero();
  return twistFromPose(T_before_now) / seconds;
}

inline const DepthFrame& preprocess(ComputeContext& compute, DepthPreprocessor& preprocessor,
                                    const RgbdFrame& frame, const Vector6d& velocity, StageTimers& timers) {
  const StageTimers::Scope timer(timers, "preprocessing");
  const DepthFrame& depth = preprocessor.process(frame, velocity);
  compute.finish();
  return depth;
}

}  // namespace depth_fusion
