// Typed launches of kernels/model_view/*.cl.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/model_view/model_view_renderer.h"
#include "map/slots_in_view.h"
#include "shared/types.h"

namespace depth_fusion {

class ModelViewRenderer::Kernels {
 public:
  Kernels(ComputeContext& compute, const BlockMap& map);

  void splatBlockRanges(BlockMap& map, DeviceBuffer& nearest, DeviceBuffer& occupied, const ModelView& view,
                        const RayRangeArgs& range);
  void raycast(BlockMap& map, const DeviceBuffer& nearest, const DeviceBuffer& occupied, ModelView& view,
               const RayRangeArgs& range);
  // picture: four bytes a pixel.
  void shadeView(const ModelView& view, DeviceBuffer& picture);
  void colorView(BlockMap& map, const ModelView& view, DeviceBuffer& picture);

 private:
  SlotsInView in_view_;
  int simd_width_;
  Kernel ranges_, raycast_, shade_, color_;
};

}  // namespace depth_fusion
