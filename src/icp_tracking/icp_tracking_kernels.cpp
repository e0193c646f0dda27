#include "icp_tracking/icp_tracking_kernels.h"

#include "frames/sensor_args.h"
#include "geometry/kernel_args.h"

namespace depth_fusion {

IcpTracker::Kernels::Kernels(ComputeContext& compute)
    : group_size_(compute.impl().simd_width == 1 ? compute.impl().group_size : 1),
      accumulate_(compute, "icp_tracking/accumulate_system.cl", "accumulate_system",
                  "-DGROUP_SIZE=" + std::to_string(group_size_)) {}

IcpSystem IcpTracker::Kernels::accumulateSystem(const DepthLevel& level, const ModelView& view,
                                                const Pose& T_M_D, const MatchGates& gates,
                                                DeviceBuffer& partial_sums) {
  const MatchingArgs args{gates.max_distance_m, gates.min_normal_cosine, gates.huber_sigmas, gates.row_step};
  const size_t rows = (level.camera.height + gates.row_step - 1) / gates.row_step;
  accumulate_.runGroups(rows, group_size_, level.depth, level.normals, view.depth, view.normals, partial_sums,
                        toArgs(level.camera), toArgs(view.camera), toArgs(T_M_D), toArgs(level.sensor), args);
  return sumRows(partial_sums.read<float>(rows * ICP_SUMS), gates.row_step);
}

}  // namespace depth_fusion
