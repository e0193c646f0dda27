// Typed launches of kernels/icp_tracking/*.cl.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/icp_tracking/icp_tracker.h"
#include "icp_tracking/icp_system.h"
#include "shared/types.h"

namespace depth_fusion {

// Which matches count, and how much.
struct MatchGates {
  float max_distance_m;
  float min_normal_cosine;
  float huber_sigmas;
  int row_step = 1;  // rows from one that is matched to the next
};

class IcpTracker::Kernels {
 public:
  explicit Kernels(ComputeContext& compute);

  // The system of matching `level` at T_M_D against the view, M being the view's camera frame.
  IcpSystem accumulateSystem(const DepthLevel& level, const ModelView& view, const Pose& T_M_D,
                             const MatchGates& gates, DeviceBuffer& partial_sums);

 private:
  size_t group_size_;
  Kernel accumulate_;
};

}  // namespace depth_fusion
