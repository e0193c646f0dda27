#include "color_fusion/color_alignment.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace depth_fusion {
namespace {

constexpr int kLevels = 3;
constexpr int kIterations = 5;
constexpr int kMinPoints = 200;
constexpr double kConverged_px = 0.02;
constexpr double kHuber = 8.0;        // brightness, of 255
constexpr double kFullWeight = 16.0;  // a map's colour of this weight counts as much as any
constexpr double kPriorRotation_rad = 0.02;
constexpr double kPriorTranslation_m = 0.004;
constexpr double kPointsPerOpinion = 50.0;  // neighbouring points share their errors

struct Point {
  Eigen::Vector3d p_W;
  double brightness, weight;
};

struct Level {
  CameraIntrinsics camera;
  cv::Mat brightness, slope_u, slope_v;  // CV_32FC1
  size_t stride = 1;                     // of the points looked at
};

std::vector<Point> brightnessOf(const std::vector<SurfaceColor>& surface) {
  std::vector<Point> points;
  points.reserve(surface.size());
  for (const SurfaceColor& point : surface) {
    points.push_back({point.p_W, point.bgr.mean(), std::min(point.weight / kFullWeight, 1.0)});
  }
  return points;
}

cv::Mat brightnessOf(const ColorImage& image, const Eigen::Array3d& gain) {
  const cv::Matx14f mean(static_cast<float>(gain[0] / 3.0), static_cast<float>(gain[1] / 3.0),
                         static_cast<float>(gain[2] / 3.0), 0.0f);
  cv::Mat channels, brightness;
  image.bgra.convertTo(channels, CV_32F);
  cv::transform(channels, brightness, mean);
  return brightness;
}

std::vector<Level> pyramidOf(const cv::Mat& brightness, CameraIntrinsics camera) {
  std::vector<Level> levels(kLevels);
  cv::Mat image = brightness;
  size_t stride = 1;
  for (Level& level : levels) {
    level.camera = camera;
    level.stride = stride;
    stride *= 2;
    level.brightness = image;
    cv::Sobel(image, level.slope_u, CV_32F, 1, 0, 3, 1.0 / 8.0);
    cv::Sobel(image, level.slope_v, CV_32F, 0, 1, 3, 1.0 / 8.0);
    camera = halved(camera);
    cv::Mat half;
    cv::resize(image, half, cv::Size(camera.width, camera.height), 0.0, 0.0, cv::INTER_AREA);
    image = half;
  }
  return levels;
}

// A place between four pixels.
struct Place {
  int u, v;
  float fu, fv;

  double in(const cv::Mat& image) const {
    const float* upper = image.ptr<float>(v) + u;
    const float* lower = image.ptr<float>(v + 1) + u;
    return (1.0f - fv) * ((1.0f - fu) * upper[0] + fu * upper[1]) +
           fv * ((1.0f - fu) * lower[0] + fu * lower[1]);
  }
};

struct System {
  Matrix6d squares = Matrix6d::Zero();
  Vector6d products = Vector6d::Zero();
  double cost = 0.0, weight = 0.0;
  int points = 0;

  double meanCost() const { return cost / weight; }
};

// Normal equations of the twist that moves the surface in front of the camera.
System systemAt(const std::vector<Point>& points, const Level& level, const Pose& T_C_W) {
  System system;
  const CameraIntrinsics& camera = level.camera;
  for (size_t i = 0; i < points.size(); i += level.stride) {
    const Point& point = points[i];
    const Eigen::Vector3d p = T_C_W * point.p_W;
    const double u = camera.fx * p.x() / p.z() + camera.cx;
    const double v = camera.fy * p.y() / p.z() + camera.cy;
    const bool inside = p.z() > 0.0 && u >= 0.0 && v >= 0.0 && u < camera.width - 1 && v < camera.height - 1;
    if (!inside) continue;
    const Place place{static_cast<int>(u), static_cast<int>(v), static_cast<float>(u - std::floor(u)),
                      static_cast<float>(v - std::floor(v))};
    const double residual = place.in(level.brightness) - point.brightness;
    const double weight = point.weight * std::min(1.0, kHuber / std::max(std::abs(residual), 1e-9));
    const double du = place.in(level.slope_u) * camera.fx / p.z();
    const double dv = place.in(level.slope_v) * camera.fy / p.z();
    const Eigen::Vector3d slope(du, dv, -(du * p.x() + dv * p.y()) / p.z());
    Vector6d row;
    row << p.cross(slope), slope;
    system.squares.noalias() += weight * row * row.transpose();
    system.products += weight * residual * row;
    system.cost += weight * residual * residual;
    system.weight += point.weight;
    ++system.points;
  }
  return system;
}

Matrix6d priorInformation() {
  Vector6d roots;
  roots << Eigen::Vector3d::Constant(kHuber / kPriorRotation_rad),
      Eigen::Vector3d::Constant(kHuber / kPriorTranslation_m);
  return roots.cwiseAbs2().asDiagonal();
}

Pose alignOnLevel(const std::vector<Point>& points, const Level& level, const Pose& prior_T_C_W, Pose T_C_W) {
  const Matrix6d information = kPointsPerOpinion * priorInformation();
  for (int i = 0; i < kIterations; ++i) {
    const System system = systemAt(points, level, T_C_W);
    if (system.points < kMinPoints) break;
    const Vector6d moved = twistFromPose(T_C_W * prior_T_C_W.inverse());
    const Vector6d twist =
        -(system.squares + information).ldlt().solve(system.products + information * moved);
    T_C_W = orthonormalized(poseFromTwist(twist) * T_C_W);
    if (twist.norm() * level.camera.fx < kConverged_px) break;
  }
  return T_C_W;
}

}  // namespace

Pose alignColor(const std::vector<SurfaceColor>& surface, const ColorImage& image, const Eigen::Array3d& gain,
                const Pose& T_C_W) {
  return alignColor(surface, image, gain, T_C_W, T_C_W);
}

Pose alignColor(const std::vector<SurfaceColor>& surface, const ColorImage& image, const Eigen::Array3d& gain,
                const Pose& T_C_W, const Pose& start_T_C_W) {
  const std::vector<Point> points = brightnessOf(surface);
  if (points.size() < kMinPoints) return start_T_C_W;
  const std::vector<Level> levels = pyramidOf(brightnessOf(image, gain), image.camera);
  Pose aligned = start_T_C_W;
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    aligned = alignOnLevel(points, *level, T_C_W, aligned);
  }
  const System before = systemAt(points, levels.front(), start_T_C_W);
  const System after = systemAt(points, levels.front(), aligned);
  return after.points >= kMinPoints && after.meanCost() < before.meanCost() ? aligned : start_T_C_W;
}

}  // namespace depth_fusion
