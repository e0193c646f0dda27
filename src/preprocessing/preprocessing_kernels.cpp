#include "preprocessing/preprocessing_kernels.h"

#include "geometry/kernel_args.h"

namespace depth_fusion {
namespace {

constexpr char kFile[] = "preprocessing/preprocessing.cl";
constexpr char kMeasurementsFile[] = "preprocessing/pack_measurements.cl";

}  // namespace

PreprocessingKernels::PreprocessingKernels(ComputeContext& compute)
    : simd_width_(compute.impl().simd_width),
      from_u16_(compute, kFile, "depth_to_metres_u16"),
      from_f32_(compute, kFile, "depth_to_metres_f32"),
      from_u16_corrected_(compute, kFile, "depth_to_metres_u16", "-DCORRECTED"),
      from_f32_corrected_(compute, kFile, "depth_to_metres_f32", "-DCORRECTED"),
      compensate_motion_(compute, "preprocessing/compensate_motion.cl", "compensate_motion"),
      bilateral_(compute, kFile, "filter_bilateral"),
      halve_(compute, kFile, "halve_depth"),
      normals_(compute, kFile, "compute_normals"),
      pack_(compute, kMeasurementsFile, "pack_measurements"),
      pack_weighted_(compute, kMeasurementsFile, "pack_measurements", "-DWEIGHTS"),
      tiles_(compute, kFile, "max_tiles") {}

void PreprocessingKernels::depthToMetres(bool is_u16, const DeviceBuffer& input, const DeviceBuffer& offsets,
                                         DeviceBuffer& depth, const CameraIntrinsics& camera,
                                         const RangeArgs& range) {
  Kernel& plain = is_u16 ? from_u16_ : from_f32_;
  Kernel& with_offsets = is_u16 ? from_u16_corrected_ : from_f32_corrected_;
  Kernel& kernel = offsets.bytes() == 0 ? plain : with_offsets;
  kernel.run2d(vectorsAcross(camera, simd_width_), camera.height, input, offsets, depth, toArgs(camera),
               range);
}

void PreprocessingKernels::compensateMotion(const DeviceBuffer& depth, DeviceBuffer& compensated,
                                            const CameraIntrinsics& camera, const SensorMotionArgs& motion) {
  compensate_motion_.run2d(vectorsAcross(camera, simd_width_), camera.height, depth, compensated,
                           toArgs(camera), motion);
}

void PreprocessingKernels::filterBilateral(const DeviceBuffer& depth, DeviceBuffer& filtered,
                                           const CameraIntrinsics& camera, const SensorArgs& sensor,
                                           const BilateralArgs& args) {
  bilateral_.run2d(vectorsAcross(camera, simd_width_), camera.height, depth, filtered, toArgs(camera), sensor,
                   args);
}

void PreprocessingKernels::halveDepth(const DepthLevel& level, DepthLevel& half, float cutoff_sigmas) {
  halve_.run2d(vectorsAcross(half.camera, simd_width_), half.camera.height, level.depth, half.depth,
               toArgs(level.camera), toArgs(half.camera), toArgs(level.sensor), cutoff_sigmas);
}

void PreprocessingKernels::computeNormals(const DeviceBuffer& depth, DeviceBuffer& normals,
                                          const CameraIntrinsics& camera, float max_relative_step) {
  normals_.run2d(vectorsAcross(camera, simd_width_), camera.height, depth, normals, toArgs(camera),
                 max_relative_step);
}

void PreprocessingKernels::packMeasurements(const DepthFrame& frame, const DeviceBuffer& weights,
                                            DeviceBuffer& measurements) {
  const DepthLevel& level = frame.levels[0];
  Kernel& pack = weights.bytes() == 0 ? pack_ : pack_weighted_;
  pack.run2d(vectorsAcross(level.camera, simd_width_), level.camera.height, level.depth, level.normals,
             weights, measurements, toArgs(level.camera), toArgs(level.sensor), frame.depth_step_m);
}

void PreprocessingKernels::maxTiles(const DeviceBuffer& depth, DeviceBuffer& tiles,
                                    const CameraIntrinsics& camera) {
  const int tile_columns = (camera.width + DEPTH_TILE - 1) / DEPTH_TILE;
  const int tile_count = tile_columns * ((camera.height + DEPTH_TILE - 1) / DEPTH_TILE);
  tiles_.run(tile_count, depth, tiles, toArgs(camera), tile_columns, tile_count);
}

}  // namespace depth_fusion
