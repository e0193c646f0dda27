#include "depth_fusion/color_fusion/color_fusion.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "color_fusion/color_alignment.h"
#include "color_fusion/color_fusion_kernels.h"
#include "color_fusion/exposure.h"
#include "depth_fusion/common/error.h"
#include "depth_fusion/compute/device_image.h"
#include "frames/sensor_args.h"
#include "geometry/kernel_args.h"

namespace depth_fusion {
namespace {

constexpr double kMeanFrames = 40.0;     // over which the mean correction is taken
constexpr double kAnchor = 0.12;         // the part of it that is taken back
constexpr double kSharpestDecay = 0.99;  // a frame
constexpr double kLeastSharpnessWeight = 0.03;

struct Float4 {
  float x, y, z, w;
};

// How much the brightness bends from pixel to pixel, as a fraction of itself: motion blur lowers it most.
double sharpnessOf(const cv::Mat& color) {
  cv::Mat half, grey, bends;
  cv::resize(color, half, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
  if (half.channels() == 3) {
    cv::cvtColor(half, grey, cv::COLOR_BGR2GRAY);
  } else {
    grey = half;
  }
  cv::Laplacian(grey, bends, CV_16S);
  return cv::norm(bends, cv::NORM_L1) / std::max(cv::sum(grey)[0], 1.0);
}

}  // namespace

// The colour image and what belongs to it, on the device in the layout of images.
struct ColorFusion::Images {
  CameraIntrinsics camera;
  DeviceBuffer pixels, depth_C;
  cv::Mat host_rows;  // the pixels with guards and padding

  Images(ComputeContext& compute, const CameraIntrinsics& color_camera)
      : camera(color_camera),
        pixels(zeroImage(compute, camera)),
        depth_C(zeroImage(compute, camera)),
        host_rows(cv::Mat::zeros(1, static_cast<int>(imageElements(camera)), CV_8UC4)) {}

  ColorImage host() {
    cv::Mat rows(camera.height, pitchOf(camera.width), CV_8UC4, host_rows.ptr<cv::Vec4b>() + IMAGE_GUARD);
    return {camera, rows.colRange(0, camera.width)};
  }

  void upload(const cv::Mat& color) {
    ColorImage image = host();
    cv::cvtColor(color, image.bgra, color.channels() == 1 ? cv::COLOR_GRAY2BGRA : cv::COLOR_BGR2BGRA);
    pixels.write(host_rows.data, host_rows.total() * host_rows.elemSize());
  }
};

ColorFusion::ColorFusion(ComputeContext& compute, BlockMap& map, const ColorFusionParameters& parameters)
    : compute_(compute),
      map_(map),
      parameters_(parameters),
      kernels_(std::make_unique<Kernels>(compute, map.parameters())) {
  validate(parameters_.table());
  check(map.hasLayer(kColorLayer), "colour cannot be fused into a map without colour; set map/color");
}

std::unique_ptr<ColorFusion> ColorFusion::create(ComputeContext& compute, BlockMap& map,
                                                 const ColorFusionParameters& parameters) {
  return map.hasLayer(kColorLayer) ? std::make_unique<ColorFusion>(compute, map, parameters) : nullptr;
}

ColorFusion::~ColorFusion() = default;

void ColorFusion::setParameters(const ColorFusionParameters& parameters) {
  validate(ColorFusionParameters(parameters).table());
  parameters_ = parameters;
}

ColorFusionResult ColorFusion::integrate(const RgbdFrame& frame, const DepthFrame& depth, const Pose& T_W_D,
                                         const DeviceBuffer& visible, size_t visible_count,
                                         StageTimers& timers) {
  ColorFusionResult result;
  result.reason = colorProblem(frame);
  if (!result.reason.empty()) return result;
  const Pose T_C_D = frame.T_C_D.value_or(Pose::Identity());
  const Pose T_C_W = T_C_D * T_W_D.inverse();
  result.T_C_W = T_C_W;
  const DeviceBuffer* depth_C = &depth.levels[0].depth;
  {
    const StageTimers::Scope timer(timers, "color_fusion/prepare");
    const CameraIntrinsics camera = colorCamera(frame);
    if (!images_ || !sameCamera(images_->camera, camera))
      images_ = std::make_unique<Images>(compute_, camera);
    images_->upload(frame.color);
    if (frame.color_intrinsics || frame.T_C_D) {
      kernels_->moveDepth(depth.levels[0], images_->depth_C, camera, T_C_D);
      depth_C = &images_->depth_C;
    }
    kernels_->ratePixels(images_->pixels, *depth_C, camera, parameters_.max_relative_step);
    compute_.finish();
  }
  {
    const StageTimers::Scope timer(timers, "color_fusion/align");
    const std::vector<SurfaceColor> surface = sampleMap(depth, T_W_D);
    const ColorImage image = images_->host();
    if (parameters_.match_exposure)
      exposure_gain_ = exposureGain(surface, image, T_C_W).value_or(exposure_gain_);
    if (parameters_.align) result.T_C_W = anchored(alignColor(surface, image, exposure_gain_, T_C_W), T_C_W);
  }
  {
    const StageTimers::Scope timer(timers, "color_fusion/integrate");
    const Eigen::Array3f gain = exposure_gain_.cast<float>();
    const auto weight_at_1m = static_cast<float>(parameters_.weight_at_1m * sharpnessWeight(frame.color));
    const ColorFusionArgs args{{gain[0], gain[1], gain[2]}, weight_at_1m,
                               parameters_.max_weight,      0.5f * map_.parameters().truncation_m,
                               parameters_.hidden_sigmas,   frame_number_++};
    kernels_->integrateColor(map_, visible, visible_count, images_->pixels, *depth_C, images_->camera, T_C_W,
                             result.T_C_W, toArgs(depth.levels[0].sensor), args);
    compute_.finish();
  }
  result.fused = true;
  result.exposure_gain = exposure_gain_;
  return result;
}

Pose ColorFusion::anchored(const Pose& aligned_T_C_W, const Pose& T_C_W) {
  const Vector6d correction = twistFromPose(aligned_T_C_W * T_C_W.inverse());
  mean_correction_ += (correction - mean_correction_) / kMeanFrames;
  return poseFromTwist(correction - kAnchor * mean_correction_) * T_C_W;
}

double ColorFusion::sharpnessWeight(const cv::Mat& color) {
  const double sharpness = sharpnessOf(color);
  sharpest_ = std::max(kSharpestDecay * sharpest_, sharpness);
  if (sharpest_ == 0.0) return 1.0;
  return std::max(std::pow(sharpness / sharpest_, parameters_.blur_exponent), kLeastSharpnessWeight);
}

std::vector<SurfaceColor> ColorFusion::sampleMap(const DepthFrame& depth, const Pose& T_W_D) {
  const DepthLevel& level = depth.levels[0];
  const int stride_px = parameters_.sample_stride_px;
  const size_t count = static_cast<size_t>(level.camera.width / stride_px) *
                       static_cast<size_t>(level.camera.height / stride_px);
  if (points_.bytes() != count * sizeof(Float4)) {
    points_ = DeviceBuffer(compute_, count * sizeof(Float4), "samples of the surface");
    found_ = DeviceBuffer(compute_, count * sizeof(Float4), "samples of the surface");
  }
  kernels_->sampleSurface(level, map_, points_, found_, T_W_D, stride_px);
  const std::vector<Float4> points = points_.read<Float4>(count);
  const std::vector<Float4> found = found_.read<Float4>(count);
  std::vector<SurfaceColor> surface;
  for (size_t i = 0; i < count; ++i) {
    const Float4& p = points[i];
    const Float4& color = found[i];
    if (color.w > 0.0f) surface.push_back({{p.x, p.y, p.z}, {color.x, color.y, color.z}, color.w});
  }
  return surface;
}

}  // namespace depth_fusion
