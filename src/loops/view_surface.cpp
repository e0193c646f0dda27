#include "loops/view_surface.h"

#include <algorithm>
#include <cmath>

#include "shared/types.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr int kMaxWidth_px = 160;
constexpr double kEdge = 0.04;         // of the depth: neighbours farther apart are not of one surface
constexpr double kMaxSlope_cos = 0.2;  // a surface seen more aslant has no normal to rely on
constexpr double kMapSigma_m = 0.004;  // of a fused surface, whatever the sensor's noise

}  // namespace

ViewSurface::ViewSurface(const KeyframeView& view, const DepthSensorParameters& sensor)
    : camera_(view.camera()), depth_m_(view.depth()) {
  while (depth_m_.cols > kMaxWidth_px) {
    depth_m_ = halvedDepth(depth_m_);
    camera_ = halved(camera_);
  }
  point_of_.assign(depth_m_.total(), -1);
  for (int v = 1; v + 1 < depth_m_.rows; ++v) {
    for (int u = 1; u + 1 < depth_m_.cols; ++u) addPoint(u, v, sensor);
  }
}

Vector3d ViewSurface::pointAt(int u, int v) const {
  const double z_m = depth_m_.at<float>(v, u);
  return z_m * Vector3d((u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy, 1.0);
}

void ViewSurface::addPoint(int u, int v, const DepthSensorParameters& sensor) {
  const double z_m = depth_m_.at<float>(v, u);
  if (!(z_m > 0.0)) return;
  for (const auto& [du, dv] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    if (!(std::abs(depth_m_.at<float>(v + dv, u + du) - z_m) < kEdge * z_m)) return;
  }
  const Vector3d point = pointAt(u, v);
  const Vector3d across =
      (pointAt(u, v + 1) - pointAt(u, v - 1)).cross(pointAt(u + 1, v) - pointAt(u - 1, v));
  const double length = across.norm();
  if (!(length > 0.0)) return;
  const Vector3d normal = across / length;
  if (-normal.dot(point.normalized()) < kMaxSlope_cos) return;
  const double sigma_m = std::hypot(AXIAL_SIGMA_M(sensor, z_m), kMapSigma_m);
  point_of_[static_cast<size_t>(v * depth_m_.cols + u)] = static_cast<int>(points_.size());
  points_.push_back({point, normal, sigma_m});
}

std::optional<std::pair<int, int>> ViewSurface::pixelOf(const Vector3d& p_D) const {
  constexpr double kNearest_m = 0.05;
  if (!(p_D.z() > kNearest_m)) return std::nullopt;
  const double u = camera_.fx * p_D.x() / p_D.z() + camera_.cx,
               v = camera_.fy * p_D.y() / p_D.z() + camera_.cy;
  if (!(u >= 0.5 && v >= 0.5 && u < depth_m_.cols - 1.5 && v < depth_m_.rows - 1.5)) return std::nullopt;
  return std::pair(static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v)));
}

const SurfacePoint* ViewSurface::seenTowards(const Vector3d& p_D) const {
  const auto pixel = pixelOf(p_D);
  if (!pixel) return nullptr;
  const int index = point_of_[static_cast<size_t>(pixel->second * depth_m_.cols + pixel->first)];
  return index < 0 ? nullptr : &points_[static_cast<size_t>(index)];
}

double ViewSurface::nearestDepth_m(const Vector3d& p_D) const {
  const auto pixel = pixelOf(p_D);
  if (!pixel) return 0.0;
  double nearest_m = 0.0;
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) {
      const double z_m = depth_m_.at<float>(pixel->second + dv, pixel->first + du);
      if (!(z_m > 0.0)) return 0.0;
      nearest_m = nearest_m == 0.0 ? z_m : std::min(nearest_m, z_m);
    }
  }
  return nearest_m;
}

namespace {

// The part of one view's surface in front of what the other camera sees, of what both see.
double seenThroughShare(const ViewSurface& surface, const ViewSurface& through,
                        const Pose& T_through_surface) {
  constexpr double kTolerance_m = 0.05, kTolerance = 0.03, kTolerance_sigmas = 4.0;
  size_t in_front = 0, seen = 0;
  for (const SurfacePoint& sample : surface.points()) {
    const Vector3d point = T_through_surface * sample.point;
    const double nearest_m = through.nearestDepth_m(point);
    if (nearest_m == 0.0) continue;
    const double tolerance_m =
        std::max({kTolerance_m, kTolerance * point.z(), kTolerance_sigmas * sample.sigma_m});
    if (point.z() > nearest_m + tolerance_m) continue;  // hidden
    ++seen;
    in_front += point.z() < nearest_m - tolerance_m;
  }
  return seen == 0 ? 0.0 : static_cast<double>(in_front) / static_cast<double>(seen);
}

}  // namespace

double contradictedShare(const ViewSurface& old_view, const ViewSurface& new_view, const Pose& T_old_new) {
  return std::max(seenThroughShare(new_view, old_view, T_old_new),
                  seenThroughShare(old_view, new_view, T_old_new.inverse()));
}

}  // namespace depth_fusion
