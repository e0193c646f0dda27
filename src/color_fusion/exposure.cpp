#include "color_fusion/exposure.h"

#include <array>

#include "depth_fusion/common/percentile.h"

namespace depth_fusion {
namespace {

constexpr double kDarkest = 16.0;
constexpr double kBrightest = 240.0;
constexpr size_t kMinRatios = 200;
constexpr double kMostGain = 4.0;

bool usable(double channel) { return channel >= kDarkest && channel <= kBrightest; }

// The pixel that shows the point, or null.
const cv::Vec4b* pixelOf(const Eigen::Vector3d& p_C, const ColorImage& image) {
  if (p_C.z() <= 0.0) return nullptr;
  const int u = cvRound(image.camera.fx * p_C.x() / p_C.z() + image.camera.cx);
  const int v = cvRound(image.camera.fy * p_C.y() / p_C.z() + image.camera.cy);
  const bool inside = u >= 0 && v >= 0 && u < image.camera.width && v < image.camera.height;
  return inside ? &image.bgra.at<cv::Vec4b>(v, u) : nullptr;
}

}  // namespace

std::optional<Eigen::Array3d> exposureGain(const std::vector<SurfaceColor>& surface, const ColorImage& image,
                                           const Pose& T_C_W) {
  std::array<std::vector<double>, 3> ratios;
  for (const SurfaceColor& point : surface) {
    const cv::Vec4b* pixel = pixelOf(T_C_W * point.p_W, image);
    if (pixel == nullptr) continue;
    for (int channel = 0; channel < 3; ++channel) {
      const double in_map = point.bgr[channel];
      const double in_image = (*pixel)[channel];
      if (usable(in_map) && usable(in_image)) ratios[channel].push_back(in_map / in_image);
    }
  }
  Eigen::Array3d gain;
  for (int channel = 0; channel < 3; ++channel) {
    if (ratios[channel].size() < kMinRatios) return std::nullopt;
    gain[channel] = percentile(std::move(ratios[channel]), 0.5);
  }
  return gain.max(1.0 / kMostGain).min(kMostGain);
}

}  // namespace depth_fusion
