// Typed launches of kernels/model_view/*.cl.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/model_view/model_view.h"

namespace depth_fusion {

class ModelViewRenderer::Kernels {
 public:

  Kernels(ComputeContext& compute, const MapParameters& map);

  void splatBlockRanges(BlockSparseMap& map, DeviceBuffer& nearest, DeviceBuffer& farthest,
                        const ModelView& view, float min_range_m, float max_range_m);
  void raycastCoarse(BlockSparseMap& map, const DeviceBuffer& nearest, const DeviceBuffer& farthest,
                     DeviceBuffer& coarse, const ModelView& view);
  void raycastFine(BlockSparseMap& map, const DeviceBuffer& coarse, ModelView& view);
  // picture: four bytes a pixel.
  void shadeView(const ModelView& view, DeviceBuffer& picture);
  void colorView(BlockSparseMap& map, const ModelView& view, DeviceBuffer& picture);

 private:
  int simd_width_;
  Kernel ranges_, coarse_, fine_, shade_, color_;
};

}  // namespace depth_fusion
