#include "color_fusion/color_fusion_kernels.h"

#include <cmath>

#include "geometry/kernel_args.h"
#include "map/map_args.h"

namespace depth_fusion {
namespace {

// Pixels of the colour camera that a pixel of the depth camera covers, along an axis.
int footprint(const CameraIntrinsics& camera, const CameraIntrinsics& color_camera) {
  return static_cast<int>(std::ceil(color_camera.fx / camera.fx)) + 1;
}

}  // namespace

ColorFusion::Kernels::Kernels(ComputeContext& compute, const MapParameters& map)
    : simd_width_(compute.impl().simd_width),
      items_per_block_(itemsPerBlock(map, simd_width_)),
      splat_(compute, "color_fusion/color_depth.cl", "splat_depth"),
      drop_unset_(compute, "color_fusion/color_depth.cl", "drop_unset_depth"),
      rate_(compute, "color_fusion/color_depth.cl", "rate_pixels"),
      sample_(compute, "color_fusion/sample_surface.cl", "sample_surface", blockSizeOption(map)),
      integrate_(compute, "color_fusion/integrate_color.cl", "integrate_color", blockSizeOption(map)) {}

void ColorFusion::Kernels::moveDepth(const DepthLevel& depth, DeviceBuffer& depth_C,
                                     const CameraIntrinsics& color_camera, const Pose& T_C_D) {
  const CameraIntrinsics& camera = depth.camera;
  depth_C.fill(NO_DEPTH_BITS, depth_C.bytes());
  splat_.run2d(camera.width, camera.height, depth.depth, depth_C, toArgs(camera), toArgs(color_camera),
               toArgs(T_C_D), footprint(camera, color_camera));
  const int elements = static_cast<int>(imageElements(color_camera));
  drop_unset_.run(elements, depth_C, elements);
}

void ColorFusion::Kernels::ratePixels(DeviceBuffer& image, const DeviceBuffer& depth_C,
                                      const CameraIntrinsics& color_camera, float max_relative_step) {
  rate_.run2d(vectorsAcross(color_camera, simd_width_), color_camera.height, image, depth_C,
              toArgs(color_camera), max_relative_step);
}

void ColorFusion::Kernels::sampleSurface(const DepthLevel& depth, BlockSparseMap& map, DeviceBuffer& points,
                                         DeviceBuffer& found, const Pose& T_W_D, int stride_px) {
  const int columns = depth.camera.width / stride_px;
  const int samples = columns * (depth.camera.height / stride_px);
  sample_.run(samples, points, found, depth.depth, map.offsets(), map.colors(), toArgs(depth.camera),
              toArgs(T_W_D), gridArgs(map), stride_px, columns, samples);
}

void ColorFusion::Kernels::integrateColor(BlockSparseMap& map, const DeviceBuffer& visible,
                                          size_t visible_count, const DeviceBuffer& image,
                                          const DeviceBuffer& depth_C, const CameraIntrinsics& color_camera,
                                          const Pose& T_C_W, const Pose& T_A_W, const SensorArgs& sensor,
                                          const ColorFusionArgs& args) {
  integrate_.run(visible_count * items_per_block_, map.colors(), map.voxels(), visible,
                 static_cast<int>(visible_count), map.blockIndices(), map.blockStates(), image, depth_C,
                 toArgs(color_camera), toArgs(T_C_W), toArgs(T_A_W), gridArgs(map), sensor, args);
}

}  // namespace depth_fusion
