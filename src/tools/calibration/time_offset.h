// By how much the clocks of two measurements of the same motion differ.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/geometry/pose.h"
#include "tools/calibration/depth_calibration.h"

namespace depth_fusion {

struct MeasuredMotion {
  double from_s = 0.0, to_s = 0.0;
  Pose T_from_to = Pose::Identity();
};

struct TimeOffset {
  bool found = false;
  std::string reason;  // why it is not; empty otherwise
  Estimate offset_s;   // the motions' stamps plus this are the trajectory's
};

// Motions in order of time, and the poses of the same body; both may have gaps.
TimeOffset findTimeOffset(const std::vector<MeasuredMotion>& motions, const Trajectory& trajectory);

}  // namespace depth_fusion
