#include "tools/calibration/plane_patches.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "shared/types.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr int kColumns = 80;
constexpr int kMaxPlanes = 3;
constexpr int kHypotheses = 60;
constexpr int kFits = 3;
constexpr double kMinPlaneCosine = 0.9;
constexpr size_t kMinPoints = 400;
constexpr double kMinExtent = 0.3;  // of the image's width or height

// A point p_D lies on the plane where plane . p_D = 1.
using Plane = Vector3d;

double inverseDepth(const ViewPoint& point) { return 1.0 / point.p_D.z(); }
double inverseSigma(const ViewPoint& point) {
  return point.sigma_m * inverseDepth(point) * inverseDepth(point);
}
Vector3d rayOf(const ViewPoint& point) { return point.p_D / point.p_D.z(); }
double residualOf(const ViewPoint& point, const Plane& plane) {
  return inverseDepth(point) - plane.dot(rayOf(point));
}

bool lies(const ViewPoint& point, const Plane& plane, double cutoff_sigmas) {
  return std::abs(residualOf(point, plane)) < cutoff_sigmas * inverseSigma(point) &&
         -plane.normalized().dot(point.normal_D) > kMinPlaneCosine;
}

Plane planeThrough(const ViewPoint& point) { return point.normal_D / point.normal_D.dot(point.p_D); }

Plane bestHypothesis(const std::vector<ViewPoint>& points, cv::RNG& random, double cutoff_sigmas) {
  Plane best = Plane::Zero();
  long most = 0;
  for (int i = 0; i < kHypotheses; ++i) {
    const Plane plane = planeThrough(points[random.uniform(0, static_cast<int>(points.size()))]);
    const long count = std::count_if(points.begin(), points.end(), [&](const ViewPoint& point) {
      return lies(point, plane, cutoff_sigmas);
    });
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  return best;
}

bool isWide(const std::vector<ViewPoint>& points, const CameraIntrinsics& camera) {
  std::vector<cv::Point> pixels;
  for (const ViewPoint& point : points) pixels.push_back(point.pixel);
  const cv::Rect extent = cv::boundingRect(pixels);
  return extent.width > kMinExtent * camera.width || extent.height > kMinExtent * camera.height;
}

class PlaneFit {
 public:
  PlaneFit(const CalibrationView& view, const std::vector<ViewPoint>& points, double cutoff_sigmas)
      : view_(view), points_(points), cutoff_sigmas_(cutoff_sigmas) {}

  Plane refined(Plane plane) const {
    for (int i = 0; i < kFits; ++i) plane += system(plane).localStep();
    return plane;
  }

  LocalSystem<3> system(const Plane& plane) const {
    LocalSystem<3> result;
    for (const ViewPoint& point : points_) {
      const ViewPoint on_plane = onPlane(point, plane);
      SparseRow row;
      view_.addDerivatives(on_plane, -inverseDepth(on_plane) * plane, row);
      result.add(-rayOf(point), row, residualOf(point, plane), weightOf(point, plane));
    }
    return result;
  }

  void note(const Plane& plane, ResidualMap& map) const {
    for (const ViewPoint& point : points_) {
      map.add(point.pixel, view_.camera(), residualOf(point, plane), weightOf(point, plane));
    }
  }

 private:
  // Derivatives and weights are those where the ray meets the plane. At the measured point their noise would
  // correlate with the residual's, and the least squares would prefer depth that shrinks.
  ViewPoint onPlane(const ViewPoint& point, const Plane& plane) const {
    ViewPoint moved = point;
    moved.p_D = rayOf(point) / plane.dot(rayOf(point));
    moved.sigma_m = AXIAL_SIGMA_M(view_.sensor(), moved.p_D.z());
    return moved;
  }

  double weightOf(const ViewPoint& point, const Plane& plane) const {
    const double sigma = inverseSigma(onPlane(point, plane));
    return tukeyWeight(residualOf(point, plane) / sigma, cutoff_sigmas_) / (sigma * sigma);
  }

  const CalibrationView& view_;
  const std::vector<ViewPoint>& points_;
  double cutoff_sigmas_;
};

}  // namespace

PlanesResult fitPlanes(const CalibrationView& view, uint64_t seed, double cutoff_sigmas, ResidualMap& map) {
  PlanesResult result;
  cv::RNG random(seed + 1);
  std::vector<ViewPoint> points = view.sample(kColumns);
  for (int i = 0; i < kMaxPlanes && points.size() >= kMinPoints; ++i) {
    const Plane hypothesis = bestHypothesis(points, random, cutoff_sigmas);
    const auto rest = std::stable_partition(points.begin(), points.end(), [&](const ViewPoint& point) {
      return lies(point, hypothesis, cutoff_sigmas);
    });
    const std::vector<ViewPoint> on_plane(points.begin(), rest);
    if (on_plane.size() < kMinPoints || !isWide(on_plane, view.camera())) break;
    const PlaneFit fit(view, on_plane, cutoff_sigmas);
    const Plane plane = fit.refined(hypothesis);
    result.equations.add(fit.system(plane).eliminated());
    fit.note(plane, map);
    ++result.planes;
    points.erase(points.begin(), rest);
  }
  return result;
}

}  // namespace depth_fusion
