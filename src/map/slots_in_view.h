// Which slots kernels over the map's blocks have to look at, so that a frame's cost goes with what is in
// view, not with the map.
#pragma once

#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"
#include "depth_fusion/map/block_map.h"

namespace depth_fusion {

// The groups of slots whose boxes reach into a camera's view, on the device (slot_in_view of
// kernels/shared/block_map.h).
class SlotsInView {
 public:
  // For maps of as many slots as `map` has at most.
  SlotsInView(ComputeContext& compute, const BlockMap& map);

  // Lists the groups of which some block may come within max_range_m of depth in the image. The kernels that
  // ran over the last list are done.
  void list(const BlockMap& map, const CameraIntrinsics& camera, const Pose& T_D_W, double max_range_m);

  const DeviceBuffer& groups() const { return groups_; }
  int groupCount() const { return static_cast<int>(listed_.size()); }
  // Work-items to run.
  size_t slots() const;

 private:
  std::vector<int> listed_;
  DeviceBuffer groups_;  // the same on the device
};

}  // namespace depth_fusion
