#include "color_fusion/color_fusion_kernels.h"

#include "geometry/kernel_args.h"
#include "map/map_args.h"

namespace depth_fusion {
ColorFusion::Kernels::Kernels(ComputeContext& compute, const MapParameters& map)
    : simd_width_(compute.impl().simd_width),
      items_per_block_(itemsPerBlock(map, simd_width_)),
      splat_(compute),
      rate_(compute, "color_fusion/rate_pixels.cl", "rate_pixels"),
      sample_(compute, "color_fusion/sample_surface.cl", "sample_surface", blockSizeOption(map)),
      integrate_(compute, "color_fusion/integrate_color.cl", "integrate_color", blockSizeOption(map)) {}

void ColorFusion::Kernels::moveDepth(const DepthLevel& depth, DeviceBuffer& depth_C,
                                     const CameraIntrinsics& color_camera, const Pose& T_C_D) {
  splat_.splat(depth.depth, depth.camera, depth_C, color_camera, T_C_D,
               splat_.footprint(depth.camera, color_camera));
  splat_.dropUnset(depth_C, color_camera);
}

void ColorFusion::Kernels::ratePixels(DeviceBuffer& image, const DeviceBuffer& depth_C,
                                      const CameraIntrinsics& color_camera, float max_relative_step) {
  rate_.run2d(vectorsAcross(color_camera, simd_width_), color_camera.height, image, depth_C,
              toArgs(color_camera), max_relative_step);
}

void ColorFusion::Kernels::sampleSurface(const DepthLevel& depth, BlockMap& map, DeviceBuffer& points,
                                         DeviceBuffer& found, const Pose& T_W_D, int stride_px) {
  const int columns = depth.camera.width / stride_px;
  const int samples = columns * (depth.camera.height / stride_px);
  sample_.run(samples, points, found, depth.depth, map.offsets(), map.layer(kColorLayer),
              toArgs(depth.camera), toArgs(T_W_D), gridArgs(map), stride_px, columns, samples);
}

void ColorFusion::Kernels::integrateColor(BlockMap& map, const DeviceBuffer& visible, size_t visible_count,
                                          const DeviceBuffer& image, const DeviceBuffer& depth_C,
                                          const CameraIntrinsics& color_camera, const Pose& T_C_W,
                                          const Pose& T_A_W, const SensorArgs& sensor,
                                          const ColorFusionArgs& args) {
  integrate_.run(visible_count * items_per_block_, map.layer(kColorLayer), map.layer(kTsdfLayer), visible,
                 static_cast<int>(visible_count), map.blockIndices(), map.blockStates(), image, depth_C,
                 toArgs(color_camera), toArgs(T_C_W), toArgs(T_A_W), gridArgs(map), sensor, args);
}

}  // namespace depth_fusion
