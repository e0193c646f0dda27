// Typed launches of kernels/preprocessing/.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/preprocessing/depth_preprocessor.h"
#include "frames/sensor_args.h"

namespace depth_fusion {

class PreprocessingKernels {
 public:
  explicit PreprocessingKernels(ComputeContext& compute);

  // `input` holds width * height values of 16 bits (or floats) and at least 16 more; `offsets` is an image of
  // what the inverse depth lacks, or an empty buffer.
  void depthToMetres(bool is_u16, const DeviceBuffer& input, const DeviceBuffer& offsets, DeviceBuffer& depth,
                     const CameraIntrinsics& camera, const RangeArgs& range);
  void compensateMotion(const DeviceBuffer& depth, DeviceBuffer& compensated, const CameraIntrinsics& camera,
                        const SensorMotionArgs& motion);
  void filterBilateral(const DeviceBuffer& depth, DeviceBuffer& filtered, const CameraIntrinsics& camera,
                       const SensorArgs& sensor, const BilateralArgs& args);
  void halveDepth(const DepthLevel& level, DepthLevel& half, float cutoff_sigmas);
  void computeNormals(const DeviceBuffer& depth, DeviceBuffer& normals, const CameraIntrinsics& camera,
                      float max_relative_step);
  // `weights` is an image of each pixel's weight, or an empty buffer.
  void packMeasurements(const DepthFrame& frame, const DeviceBuffer& weights, DeviceBuffer& measurements);
  void maxTiles(const DeviceBuffer& depth, DeviceBuffer& tiles, const CameraIntrinsics& camera);

 private:
  int simd_width_;
  Kernel from_u16_, from_f32_, from_u16_corrected_, from_f32_corrected_, compensate_motion_, bilateral_,
      halve_, normals_, pack_, pack_weighted_, tiles_;
};

}  // namespace depth_fusion
