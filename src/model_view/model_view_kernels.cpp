#include "model_view/model_view_kernels.h"

#include "geometry/kernel_args.h"
#include "map/map_args.h"

namespace depth_fusion {

ModelViewRenderer::Kernels::Kernels(ComputeContext& compute, const MapParameters& map)
    : simd_width_(compute.impl().simd_width),
      ranges_(compute, "model_view/block_ranges.cl", "splat_block_ranges", blockSizeOption(map)),
      coarse_(compute, "model_view/raycast.cl", "raycast_coarse", blockSizeOption(map)),
      fine_(compute, "model_view/raycast.cl", "raycast_fine", blockSizeOption(map)),
      shade_(compute, "model_view/pictures.cl", "shade_view", blockSizeOption(map)),
      color_(compute, "model_view/pictures.cl", "color_view", blockSizeOption(map)) {}

void ModelViewRenderer::Kernels::splatBlockRanges(BlockSparseMap& map, DeviceBuffer& nearest,
                                                  DeviceBuffer& farthest, const ModelView& view,
                                                  float min_range_m, float max_range_m) {
  ranges_.run(map.slotBound(), map.blockIndices(), map.blockStates(), map.slotBound(), nearest, farthest,
              toArgs(view.camera), toArgs(Pose(view.T_W_D.inverse())), gridArgs(map), min_range_m,
              max_range_m);
}

void ModelViewRenderer::Kernels::raycastCoarse(BlockSparseMap& map, const DeviceBuffer& nearest,
                                               const DeviceBuffer& farthest, DeviceBuffer& coarse,
                                               const ModelView& view) {
  const int columns = RAY_PATCH_COLUMNS(simd_width_);
  const int rows = simd_width_ / columns;
  coarse_.run2d((view.camera.width + columns - 1) / columns, (view.camera.height + rows - 1) / rows,
                map.offsets(), map.voxels(), nearest, farthest, coarse, toArgs(view.camera),
                toArgs(view.T_W_D), gridArgs(map));
}

void ModelViewRenderer::Kernels::raycastFine(BlockSparseMap& map, const DeviceBuffer& coarse,
                                             ModelView& view) {
  fine_.run2d(vectorsAcross(view.camera, simd_width_), view.camera.height, map.offsets(), map.voxels(),
              coarse, view.depth, view.normals, static_cast<int>(planeElements(view.camera)),
              toArgs(view.camera), toArgs(view.T_W_D), gridArgs(map));
}

void ModelViewRenderer::Kernels::shadeView(const ModelView& view, DeviceBuffer& picture) {
  shade_.run2d(view.camera.width, view.camera.height, picture, view.depth, view.normals,
               static_cast<int>(planeElements(view.camera)), toArgs(view.camera));
}

void ModelViewRenderer::Kernels::colorView(BlockSparseMap& map, const ModelView& view,
                                           DeviceBuffer& picture) {
  color_.run2d(view.camera.width, view.camera.height, picture, view.depth, map.offsets(), map.colors(),
               toArgs(view.camera), toArgs(view.T_W_D), gridArgs(map));
}

}  // namespace depth_fusion
