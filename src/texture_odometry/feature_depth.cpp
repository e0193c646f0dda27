#include "texture_odometry/feature_depth.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "shared/types.h"

namespace depth_fusion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kRadius_px = 2;
constexpr int kMinPixels = 13;
constexpr double kMaxResidual_sigmas = 4.0;
constexpr int kSearchSteps = 8;
constexpr double kSearchTolerance_px = 0.3;

// Returns 0 where there is no depth.
double meanDepth_m(const RgbdFrame& frame) {
  constexpr double kInfinite = 1e9;
  return frame.depth_unit_m * cv::mean(frame.depth, (frame.depth > 0.0) & (frame.depth < kInfinite))[0];
}

class SurfaceFinder {
 public:
  SurfaceFinder(const RgbdFrame& frame, const FrameFeatures& features)
      : frame_(frame),
        camera_C_(features.camera),
        T_D_C_(features.T_C_D.inverse()),
        sensor_(features.depth_sensor),
        mean_depth_m_(meanDepth_m(frame)) {}

  std::optional<Vector3d> find(const Vector2d& pixel_C) const {
    if (!(mean_depth_m_ > 0.0)) return std::nullopt;
    const Vector3d ray_C = rayThrough(camera_C_, pixel_C);
    for (const double start : {1.0, 0.4, 2.0}) {
      const std::optional<Vector2d> pixel_D = depthPixel(ray_C, start * mean_depth_m_);
      const std::optional<Vector3d> surface_D = pixel_D ? fitPlane(*pixel_D) : std::nullopt;
      if (!surface_D) continue;
      const Vector3d surface_C =
          T_D_C_.linear().transpose() * *surface_D / (1.0 - surface_D->dot(T_D_C_.translation()));
      if (surface_C.dot(ray_C) > 0.0) return surface_C;
    }
    return std::nullopt;
  }

 private:
  double depthAt(int u, int v) const {
    if (u < 0 || v < 0 || u >= frame_.depth.cols || v >= frame_.depth.rows) return 0.0;
    const double units =
        frame_.depth.type() == CV_16UC1 ? frame_.depth.at<uint16_t>(v, u) : frame_.depth.at<float>(v, u);
    return std::isfinite(units) ? units * frame_.depth_unit_m : 0.0;
  }

  // The depth camera sees elsewhere what the colour camera sees along the ray. That place is a fixed point,
  // for it depends on the depth itself.
  std::optional<Vector2d> depthPixel(const Vector3d& ray_C, double start_m) const {
    Vector2d pixel = project(frame_.intrinsics, T_D_C_ * (start_m * ray_C));
    for (int step = 0; step < kSearchSteps; ++step) {
      const double z_D_m =
          depthAt(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
      if (z_D_m <= 0.0) return std::nullopt;
      const double z_C_m = (z_D_m - T_D_C_.translation().z()) / T_D_C_.linear().row(2).dot(ray_C);
      const Vector2d next = project(frame_.intrinsics, T_D_C_ * (z_C_m * ray_C));
      if ((next - pixel).norm() < kSearchTolerance_px) return next;
      pixel = next;
    }
    return std::nullopt;
  }

  // The fit is one of least squares over inverse depths, which are linear in the pixel on a plane. There is
  // none at a depth edge.
  std::optional<Vector3d> fitPlane(const Vector2d& pixel) const {
    const int centre_u = static_cast<int>(std::lround(pixel.x()));
    const int centre_v = static_cast<int>(std::lround(pixel.y()));
    std::array<std::pair<Vector3d, double>, (2 * kRadius_px + 1) * (2 * kRadius_px + 1)> samples;
    int count = 0;
    Matrix3d squares = Matrix3d::Zero();
    Vector3d products = Vector3d::Zero();
    for (int v = -kRadius_px; v <= kRadius_px; ++v) {
      for (int u = -kRadius_px; u <= kRadius_px; ++u) {
        const double z_m = depthAt(centre_u + u, centre_v + v);
        if (z_m <= 0.0) continue;
        const Vector3d offset(u, v, 1.0);
        samples[count++] = {offset, z_m};
        squares += offset * offset.transpose();
        products += offset / z_m;
      }
    }
    if (count < kMinPixels) return std::nullopt;
    const Vector3d plane = squares.ldlt().solve(products);
    for (int i = 0; i < count; ++i) {
      const auto& [offset, z_m] = samples[i];
      const double residual_m = 1.0 / plane.dot(offset) - z_m;
      if (!(std::abs(residual_m) < kMaxResidual_sigmas * AXIAL_SIGMA_M(sensor_, z_m))) return std::nullopt;
    }
    return planeOfPixels(plane, centre_u, centre_v);
  }

  // Turns inverse depth over offsets from a pixel into inverse depth over (x/z, y/z, 1).
  Vector3d planeOfPixels(const Vector3d& plane, int centre_u, int centre_v) const {
    const CameraIntrinsics& camera = frame_.intrinsics;
    return {plane.x() * camera.fx, plane.y() * camera.fy,
            plane.z() + plane.x() * (camera.cx - centre_u) + plane.y() * (camera.cy - centre_v)};
  }

  const RgbdFrame& frame_;
  const CameraIntrinsics& camera_C_;
  Pose T_D_C_;
  DepthSensorParameters sensor_;
  double mean_depth_m_;
};

}  // namespace

void findSurfaces(const RgbdFrame& frame, FrameFeatures& features) {
  const SurfaceFinder finder(frame, features);
  for (Feature& feature : features.features) {
    feature.surface_C = finder.find(fullImagePixel(feature.pixel, feature.level));
  }
}

}  // namespace depth_fusion
