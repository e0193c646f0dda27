// Typed launches of kernels/registration/splat_depth.cl.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/geometry/camera_intrinsics.h"
#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

class DepthSplatKernels {
 public:
  explicit DepthSplatKernels(ComputeContext& compute);

  // Pixels of camera C that a pixel of camera D covers, along an axis.
  static int footprint(const CameraIntrinsics& camera, const CameraIntrinsics& other_camera);
  // depth_C: an image of other_camera; where nothing comes to lie, NO_DEPTH_BITS.
  void splat(const DeviceBuffer& depth, const CameraIntrinsics& camera, DeviceBuffer& depth_C,
             const CameraIntrinsics& other_camera, const Pose& T_C_D, int footprint);
  // NO_DEPTH_BITS becomes 0.
  void dropUnset(DeviceBuffer& depth_C, const CameraIntrinsics& other_camera);

 private:
  int simd_width_;
  Kernel splat_, drop_unset_;
};

}  // namespace depth_fusion
