#include "model_view/model_view_kernels.h"

#include "geometry/kernel_args.h"
#include "map/map_args.h"

namespace depth_fusion {

ModelViewRenderer::Kernels::Kernels(ComputeContext& compute, const BlockMap& map)
    : in_view_(compute, map),
      simd_width_(compute.impl().simd_width),
      ranges_(compute, "model_view/block_ranges.cl", "splat_block_ranges", blockSizeOption(map.parameters())),
      raycast_(compute, "model_view/raycast.cl", "raycast", blockSizeOption(map.parameters())),
      shade_(compute, "model_view/pictures.cl", "shade_view", blockSizeOption(map.parameters())),
      color_(compute, "model_view/pictures.cl", "color_view", blockSizeOption(map.parameters())) {}

void ModelViewRenderer::Kernels::splatBlockRanges(BlockMap& map, DeviceBuffer& nearest,
                                                  DeviceBuffer& occupied, const ModelView& view,
                                                  const RayRangeArgs& range) {
  const Pose T_D_W = view.T_W_D.inverse();
  in_view_.list(map, view.camera, T_D_W, range.max_m);
  ranges_.run(in_view_.slots(), in_view_.groups(), in_view_.groupCount(), map.slots().bound(),
              map.blockIndices(), map.blockStates(), nearest, occupied, toArgs(view.camera), toArgs(T_D_W),
              gridArgs(map), range);
}

void ModelViewRenderer::Kernels::raycast(BlockMap& map, const DeviceBuffer& nearest,
                                         const DeviceBuffer& occupied, ModelView& view,
                                         const RayRangeArgs& range) {
  const int columns = RAY_PATCHES(simd_width_) * RAY_STRIDE * RAY_PATCH_COLUMNS(simd_width_);
  const int rows = RAY_STRIDE * simd_width_ / RAY_PATCH_COLUMNS(simd_width_);
  raycast_.run2d((view.camera.width + columns - 1) / columns, (view.camera.height + rows - 1) / rows,
                 map.offsets(), map.layer(kTsdfLayer), nearest, occupied, view.depth, view.normals,
                 toArgs(view.camera), toArgs(view.T_W_D), gridArgs(map), range);
}

void ModelViewRenderer::Kernels::shadeView(const ModelView& view, DeviceBuffer& picture) {
  shade_.run2d(view.camera.width, view.camera.height, picture, view.depth, view.normals, toArgs(view.camera));
}

void ModelViewRenderer::Kernels::colorView(BlockMap& map, const ModelView& view, DeviceBuffer& picture) {
  color_.run2d(view.camera.width, view.camera.height, picture, view.depth, map.offsets(),
               map.layer(kColorLayer), toArgs(view.camera), toArgs(view.T_W_D), gridArgs(map));
}

}  // namespace depth_fusion
