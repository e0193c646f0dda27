// Typed launches of kernels/color_fusion/*.cl.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/color_fusion/color_fusion.h"
#include "registration/depth_splat_kernels.h"
#include "shared/types.h"

namespace depth_fusion {

class ColorFusion::Kernels {
 public:
  Kernels(ComputeContext& compute, const MapParameters& map);

  // depth_C: an image of the colour camera.
  void moveDepth(const DepthLevel& depth, DeviceBuffer& depth_C, const CameraIntrinsics& color_camera,
                 const Pose& T_C_D);
  void ratePixels(DeviceBuffer& image, const DeviceBuffer& depth_C, const CameraIntrinsics& color_camera,
                  float max_relative_step);
  // points, found: one sample of each stride_px x stride_px pixels, row by row.
  void sampleSurface(const DepthLevel& depth, BlockMap& map, DeviceBuffer& points, DeviceBuffer& found,
                     const Pose& T_W_D, int stride_px);
  // T_C_W: of the colour camera by depth and calibration; T_A_W: where its colours fit the map's.
  void integrateColor(BlockMap& map, const DeviceBuffer& visible, size_t visible_count,
                      const DeviceBuffer& image, const DeviceBuffer& depth_C,
                      const CameraIntrinsics& color_camera, const Pose& T_C_W, const Pose& T_A_W,
                      const SensorArgs& sensor, const ColorFusionArgs& args);

 private:
  int simd_width_;
  size_t items_per_block_;
  DepthSplatKernels splat_;
  Kernel rate_, sample_, integrate_;
};

}  // namespace depth_fusion
