#include "depth_fusion/model_view/model_view_renderer.h"

#include <opencv2/imgproc.hpp>

#include "depth_fusion/common/error.h"
#include "depth_fusion/compute/device_image.h"
#include "model_view/mesh_renderer.h"
#include "model_view/model_view_kernels.h"
#include "shared/types.h"

namespace depth_fusion {
namespace {

constexpr size_t kPictureBytes = 4;  // a pixel

size_t pixelsOf(const CameraIntrinsics& camera) { return static_cast<size_t>(camera.width) * camera.height; }

size_t rangeTiles(const CameraIntrinsics& camera) {
  const auto tiles = [](int pixels) { return static_cast<size_t>((pixels + RANGE_TILE - 1) / RANGE_TILE); };
  return tiles(camera.width) * tiles(camera.height);
}

std::shared_ptr<ModelView> makeView(ComputeContext& compute, const CameraIntrinsics& camera) {
  auto view = std::make_shared<ModelView>();
  view->camera = camera;
  view->depth = zeroImage(compute, camera);
  view->normals = zeroImage(compute, camera);
  return view;
}

}  // namespace

ModelViewRenderer::ModelViewRenderer(ComputeContext& compute, BlockMap& map, const CameraIntrinsics& camera,
                                     ModelViewParameters parameters)
    : compute_(compute),
      map_(map),
      camera_(parameters.half_size ? halved(camera) : camera),
      views_([this] { return makeView(compute_, camera_); }),
      nearest_(compute, rangeTiles(camera_) * sizeof(float), "ray ranges"),
      occupied_(compute, rangeTiles(camera_) * (DEPTH_BINS / 8), "ray ranges"),
      kernels_(std::make_unique<Kernels>(compute, map)) {
  validate(parameters.table());
  if (renderers().of(parameters.renderer) == Renderer::kMarchingCubes)
    mesh_renderer_ = std::make_unique<MeshRenderer>(compute, map, camera_);
}

ModelViewRenderer::~ModelViewRenderer() = default;

const ModelView& ModelViewRenderer::render(const Pose& T_W_D, float min_range_m, float max_range_m,
                                           StageTimers& timers) {
  ModelView& view = *views_.next();
  view.T_W_D = T_W_D;
  if (mesh_renderer_) {
    mesh_renderer_->render(view, min_range_m, max_range_m, timers);
    return view;
  }
  const RayRangeArgs range = {min_range_m, max_range_m, DEPTH_BINS / (max_range_m - min_range_m)};
  {
    const StageTimers::Scope timer(timers, "model_view/ranges");
    nearest_.fill(NO_DEPTH_BITS, nearest_.bytes());
    occupied_.fill(0, occupied_.bytes());
    kernels_->splatBlockRanges(map_, nearest_, occupied_, view, range);
    compute_.finish();
  }
  {
    const StageTimers::Scope timer(timers, "model_view/raycast");
    kernels_->raycast(map_, nearest_, occupied_, view, range);
    compute_.finish();
  }
  return view;
}

cv::Mat ModelViewRenderer::shadedPicture() {
  allocatePicture();
  kernels_->shadeView(*view(), picture_);
  return readPicture();
}

cv::Mat ModelViewRenderer::coloredPicture() {
  check(map_.hasLayer(kColorLayer), "a map without colour has no coloured view; set map/color");
  allocatePicture();
  kernels_->colorView(map_, *view(), picture_);
  return readPicture();
}

void ModelViewRenderer::allocatePicture() {
  if (picture_.bytes() == 0)
    picture_ = DeviceBuffer(compute_, kPictureBytes * pixelsOf(view()->camera), "a picture");
}

cv::Mat ModelViewRenderer::readPicture() const {
  cv::Mat picture(view()->camera.height, view()->camera.width, CV_8UC4), bgr;
  picture_.read(picture.data, kPictureBytes * pixelsOf(view()->camera));
  cv::cvtColor(picture, bgr, cv::COLOR_BGRA2BGR);
  return bgr;
}

}  // namespace depth_fusion
