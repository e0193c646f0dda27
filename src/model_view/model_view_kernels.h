// Typed launches of kernels/model_view/*.cl.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/model_view/model_view_renderer.h"
#include "map/slots_in_view.h"
#include "shared/types.h"

namespace depth_fusion {

class ModelViewRenderer::Kernels {
 public:
  Kernels(ComputeContext& compute, const BlockSparseMap& map);

  void splatBlockRanges(BlockSparseMap& map, DeviceBuffer& nearest, DeviceBuffer& occupied,
                        const ModelView& view, const RayRangeArgs& range);
  void raycast(BlockSparseMap& map, const DeviceBuffer& nearest, const DeviceBuffer& occupied,
               ModelView& view, const RayRangeArgs& range);
  // picture: four bytes a pixel.
  void shadeView(const ModelView& view, DeviceBuffer& picture);
  void colorView(BlockSparseMap& map, const ModelView& view, DeviceBuffer& picture);

 private:
  SlotsInView in_view_;
  int simd_width_;
  Kernel ranges_, raycast_, shade_, color_;
};

}  // namespace depth_fusion
