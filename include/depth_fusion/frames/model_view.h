// Depth and normals of the map as a camera sees it.
#pragma once

#include "depth_fusion/compute/device_buffer.h"
#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// On the device (image layout: kernels/shared/types.h).
struct ModelView {
  CameraIntrinsics camera;
  Pose T_W_D = Pose::Identity();
  DeviceBuffer depth;    // metres, 0 = no surface
  DeviceBuffer normals;  // unit normals towards free space in frame D, packed (kernels/shared/normal.h), 0 =
                         // no surface
};

}  // namespace depth_fusion
