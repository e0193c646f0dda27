// Typed launches of kernels/preprocessing/.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "shared/types.h"

namespace depth_fusion {

class DepthPreprocessingKernels {
 public:
  static constexpr int kTile = 16;

  explicit DepthPreprocessingKernels(ComputeContext& compute);

  // input: width * height values of 16 bits (or floats) and at least 16 more.
  void depthToMetres(bool is_u16, const DeviceBuffer& input, DeviceBuffer& depth, const CameraIntrinsics& camera,
                     const RangeArgs& range);
  void compensateMotion(const DeviceBuffer& depth, DeviceBuffer& compensated, const CameraIntrinsics& camera,
                        const SensorMotionArgs& motion);
  void filterBilateral(const DeviceBuffer& depth, DeviceBuffer& filtered, const CameraIntrinsics& camera,
                       const BilateralArgs& args);
  void halveDepth(const DepthLevel& level, DepthLevel& half, float cutoff_sigmas);
  void computeNormals(const DeviceBuffer& depth, DeviceBuffer& normals, const CameraIntrinsics& camera,
                      float max_relative_step);
  void maxTiles(const DeviceBuffer& depth, DeviceBuffer& tiles, const CameraIntrinsics& camera);

 private:
  int simd_width_;
  Kernel from_u16_, from_f32_, compensate_motion_, bilateral_, halve_, normals_, tiles_;
};

}  // namespace depth_fusion
