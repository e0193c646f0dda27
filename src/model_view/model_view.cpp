#include "depth_fusion/model_view/model_view.h"

#include "depth_fusion/compute/device_image.h"
#include "model_view/model_view_kernels.h"
#include "shared/types.h"

namespace depth_fusion {
namespace {

constexpr int kFarFloatBits = 0x7f7fffff;  // the largest float

size_t rangeTiles(const CameraIntrinsics& camera, int tile) {
  return static_cast<size_t>((camera.width + tile - 1) / tile) * ((camera.height + tile - 1) / tile);
}

}  // namespace

ModelViewRenderer::ModelViewRenderer(ComputeContext& compute, BlockSparseMap& map, const CameraIntrinsics& camera)
    : compute_(compute),
      map_(map),
      nearest_(compute, rangeTiles(camera, RANGE_TILE) * sizeof(float), "ray ranges"),
      farthest_(compute, rangeTiles(camera, RANGE_TILE) * sizeof(float), "ray ranges"),
      coarse_(zeroImage(compute, camera, 1)),
      kernels_(std::make_unique<Kernels>(compute, map.parameters())) {
  view_.camera = camera;
  view_.depth = zeroImage(compute, camera, 1);
  view_.normals = zeroImage(compute, camera, 3);
}

ModelViewRenderer::~ModelViewRenderer() = default;

const ModelView& ModelViewRenderer::render(const Pose& T_W_D, float min_range_m, float max_range_m,
                                           StageTimers& timers) {
  view_.T_W_D = T_W_D;
  {
    const StageTimers::Scope timer(timers, "model_view/ranges");
    nearest_.fill(kFarFloatBits, nearest_.bytes());
    farthest_.fill(0, farthest_.bytes());
    kernels_->splatBlockRanges(map_, nearest_, farthest_, view_, min_range_m, max_range_m);
    compute_.finish();
  }
  {
    const StageTimers::Scope timer(timers, "model_view/coarse");
    kernels_->raycastCoarse(map_, nearest_, farthest_, coarse_, view_);
    compute_.finish();
  }
  {
    const StageTimers::Scope timer(timers, "model_view/fine");
    kernels_->raycastFine(map_, coarse_, view_);
    compute_.finish();
  }
  return view_;
}

}  // namespace depth_fusion
