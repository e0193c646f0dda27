#include "tsdf_fusion/tsdf_fusion_kernels.h"

#include "frames/sensor_args.h"
#include "geometry/kernel_args.h"
#include "map/map_args.h"
#include "tsdf_fusion/filter_options.h"

namespace depth_fusion {
namespace {

static_assert(SLOTS_PER_GROUP % SLOTS_PER_ITEM(16) == 0, "a work-item's slots are of one group");

constexpr char kSelection[] = "tsdf_fusion/select_blocks.cl";

}  // namespace

TsdfFusion::Kernels::Kernels(ComputeContext& compute, const BlockMap& map,
                             const TsdfFusionParameters& parameters)
    : in_view_(compute, map),
      simd_width_(compute.impl().simd_width),
      items_per_block_(itemsPerBlock(map.parameters(), simd_width_)),
      request_(compute, kSelection, "request_blocks", blockSizeOption(map.parameters())),
      visible_(compute, kSelection, "list_visible_blocks", blockSizeOption(map.parameters())),
      integrate_(compute, "tsdf_fusion/integrate_blocks.cl", "integrate_blocks",
                 blockSizeOption(map.parameters()) + filterOptions(parameters)),
      empty_(compute, kSelection, "list_empty_blocks", blockSizeOption(map.parameters())) {}

void TsdfFusion::Kernels::requestBlocks(const DepthFrame& frame, BlockMap& map, DeviceBuffer& requests,
                                        DeviceBuffer& count, DeviceBuffer& points_outside, const Pose& T_W_D,
                                        const SelectionArgs& args) {
  const CameraIntrinsics& camera = frame.levels[0].camera;
  const auto samples = [&](int pixels) { return (pixels + args.stride_px - 1) / args.stride_px; };
  const size_t vectors = (samples(camera.width) + simd_width_ - 1) / simd_width_;
  request_.run2d(vectors, samples(camera.height), frame.raw_depth, map.offsets(), requests, count,
                 points_outside, toArgs(camera), toArgs(T_W_D), gridArgs(map), args);
}

void TsdfFusion::Kernels::listVisibleBlocks(const DepthFrame& frame, BlockMap& map, DeviceBuffer& visible,
                                            DeviceBuffer& count, const Pose& T_D_W) {
  const CameraIntrinsics& camera = frame.levels[0].camera;
  in_view_.list(map, camera, T_D_W, frame.maxRange_m() + map.parameters().truncation_m / MIN_COSINE);
  visible_.run(in_view_.slots() / SLOTS_PER_ITEM(simd_width_), in_view_.groups(), in_view_.groupCount(),
               map.slots().bound(), map.blockIndices(), map.blockStates(), frame.max_tiles, visible, count,
               toArgs(camera), toArgs(T_D_W), gridArgs(map));
}

void TsdfFusion::Kernels::integrateBlocks(const DepthFrame& frame, BlockMap& map, const DeviceBuffer& visible,
                                          int visible_count, const Pose& T_D_W, const FusionArgs& args) {
  const DepthLevel& level = frame.levels[0];
  integrate_.run(visible_count * items_per_block_, map.layer(kTsdfLayer), visible, visible_count,
                 map.blockIndices(), map.blockStates(), frame.measurements, level.normals,
                 toArgs(level.camera), toArgs(T_D_W), gridArgs(map), toArgs(level.sensor), args);
}

void TsdfFusion::Kernels::listEmptyBlocks(BlockMap& map, const DeviceBuffer& visible, int visible_count,
                                          DeviceBuffer& empty, DeviceBuffer& count) {
  empty_.run(visible_count, map.offsets(), map.blockIndices(), map.blockStates(), visible, visible_count,
             empty, count, gridArgs(map));
}

}  // namespace depth_fusion
