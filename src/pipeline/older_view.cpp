#include "depth_fusion/pipeline/older_view.h"

namespace depth_fusion {
namespace {

void copy(ComputeContext& compute, const DeviceBuffer& source, DeviceBuffer& destination) {
  if (destination.bytes() != source.bytes())
    destination = DeviceBuffer(compute, source.bytes(), "older view");
  destination.copyFrom(source, source.bytes());
}

}  // namespace

void OlderView::keep(const ModelView& view) {
  view_.camera = view.camera;
  view_.T_W_D = view.T_W_D;
  copy(compute_, view.depth, view_.depth);
  copy(compute_, view.normals, view_.normals);
  compute_.finish();  // then the view may change
  is_kept_ = true;
}

}  // namespace depth_fusion
