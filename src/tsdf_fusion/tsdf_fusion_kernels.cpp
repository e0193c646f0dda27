#include "tsdf_fusion/tsdf_fusion_kernels.h"

#include "geometry/kernel_args.h"
#include "map/map_args.h"

namespace depth_fusion {

TsdfFusion::Kernels::Kernels(ComputeContext& compute, const MapParameters& map)
    : items_per_block_(compute.impl().simd_width == 1 ? map.block_size * map.block_size * map.block_size
                                                      : map.block_size),
      request_(compute, "tsdf_fusion/select_blocks.cl", "request_blocks", blockSizeOption(map)),
      visible_(compute, "tsdf_fusion/select_blocks.cl", "list_visible_blocks", blockSizeOption(map)),
      integrate_(compute, "tsdf_fusion/integrate_blocks.cl", "integrate_blocks", blockSizeOption(map)),
      empty_(compute, "tsdf_fusion/select_blocks.cl", "list_empty_blocks", blockSizeOption(map)) {}

void TsdfFusion::Kernels::requestBlocks(const DepthFrame& frame, BlockSparseMap& map, DeviceBuffer& requests,
                                        DeviceBuffer& count, const Pose& T_W_D, const SelectionArgs& args) {
  const CameraIntrinsics& camera = frame.levels[0].camera;
  const auto samples = [&](int pixels) { return (pixels + args.stride_px - 1) / args.stride_px; };
  request_.run2d(samples(camera.width), samples(camera.height), frame.raw_depth, map.offsets(),
                 requests, count, toArgs(camera), toArgs(T_W_D), gridArgs(map), args);
}

void TsdfFusion::Kernels::listVisibleBlocks(const DepthFrame& frame, BlockSparseMap& map, DeviceBuffer& visible,
                                            DeviceBuffer& count, const Pose& T_D_W) {
  visible_.run(map.slotBound(), map.blockIndices(), map.blockStates(), frame.max_tiles, visible, count,
               map.slotBound(), toArgs(frame.levels[0].camera), toArgs(T_D_W), gridArgs(map));
}

void TsdfFusion::Kernels::integrateBlocks(const DepthFrame& frame, BlockSparseMap& map, const DeviceBuffer& visible,
                                          int visible_count, const Pose& T_D_W, const FusionArgs& args) {
  integrate_.run(visible_count * items_per_block_, map.voxels(), visible, visible_count, map.blockIndices(),
                 map.blockStates(), frame.levels[0].depth, toArgs(frame.levels[0].camera), toArgs(T_D_W), gridArgs(map),
                 args);
}

void TsdfFusion::Kernels::listEmptyBlocks(BlockSparseMap& map, const DeviceBuffer& visible, int visible_count,
                                          DeviceBuffer& empty, DeviceBuffer& count) {
  empty_.run(visible_count, map.offsets(), map.blockIndices(), map.blockStates(), visible, visible_count, empty,
             count, gridArgs(map));
}

}  // namespace depth_fusion
