#include "registration/depth_splat_kernels.h"

#include <cmath>

#include "geometry/kernel_args.h"

namespace depth_fusion {

DepthSplatKernels::DepthSplatKernels(ComputeContext& compute)
    : simd_width_(compute.impl().simd_width),
      splat_(compute, "registration/splat_depth.cl", "splat_depth"),
      drop_unset_(compute, "registration/splat_depth.cl", "drop_unset_depth") {}

int DepthSplatKernels::footprint(const CameraIntrinsics& camera, const CameraIntrinsics& other_camera) {
  return static_cast<int>(std::ceil(other_camera.fx / camera.fx)) + 1;
}

void DepthSplatKernels::splat(const DeviceBuffer& depth, const CameraIntrinsics& camera,
                              DeviceBuffer& depth_C, const CameraIntrinsics& other_camera, const Pose& T_C_D,
                              int footprint) {
  depth_C.fill(NO_DEPTH_BITS, depth_C.bytes());
  splat_.run2d(vectorsAcross(camera, simd_width_), camera.height, depth, depth_C, toArgs(camera),
               toArgs(other_camera), toArgs(T_C_D), footprint);
}

void DepthSplatKernels::dropUnset(DeviceBuffer& depth_C, const CameraIntrinsics& other_camera) {
  const int elements = static_cast<int>(imageElements(other_camera));
  drop_unset_.run(elements, depth_C, elements);
}

}  // namespace depth_fusion
