#include "tools/simulation/primitive.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

double boxDistance(const Vector3d& p_S, const Vector3d& half_size_m) {
  const Vector3d excess = p_S.cwiseAbs() - half_size_m;
  return excess.cwiseMax(0.0).norm() + std::min(excess.maxCoeff(), 0.0);
}

double cylinderDistance(const Vector3d& p_S, const Vector3d& half_size_m) {
  const double radial = std::hypot(p_S.x(), p_S.y()) - half_size_m.x();
  const double axial = std::abs(p_S.z()) - half_size_m.z();
  return std::hypot(std::max(radial, 0.0), std::max(axial, 0.0)) + std::min(std::max(radial, axial), 0.0);
}

double capsuleDistance(const Vector3d& p_S, const Vector3d& half_size_m) {
  const double axial = std::max(std::abs(p_S.z()) - half_size_m.z(), 0.0);
  return std::sqrt(p_S.x() * p_S.x() + p_S.y() * p_S.y() + axial * axial) - half_size_m.x();
}

double torusDistance(const Vector3d& p_S, const Vector3d& half_size_m) {
  return std::hypot(std::hypot(p_S.x(), p_S.y()) - half_size_m.x(), p_S.z()) - half_size_m.z();
}

Pose poseWithZ(const Vector3d& origin_W, const Vector3d& z_W) {
  Pose T_W_S = Pose::Identity();
  T_W_S.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), z_W).toRotationMatrix();
  T_W_S.translation() = origin_W;
  return T_W_S;
}

Primitive alongAxis(Shape shape, const Vector3d& from_W, const Vector3d& to_W, double radius_m,
                    const Material& material) {
  return Primitive(shape, poseWithZ((from_W + to_W) / 2.0, to_W - from_W),
                   {radius_m, radius_m, (to_W - from_W).norm() / 2.0}, material);
}

}  // namespace

Primitive::Primitive(Shape shape, const Pose& T_W_S, const Vector3d& half_size_m, const Material& material,
                     double rounding_m)
    : shape_(shape),
      T_W_S_(T_W_S),
      R_S_W_(T_W_S.linear().transpose()),
      half_size_m_(half_size_m),
      material_(material),
      rounding_m_(rounding_m) {}

double Primitive::distance(const Vector3d& p_W) const {
  return distanceInS(R_S_W_ * (p_W - T_W_S_.translation()));
}

double Primitive::distanceInS(const Vector3d& p_S) const {
  switch (shape_) {
    case Shape::kBox:
      return boxDistance(p_S, half_size_m_.array() - rounding_m_) - rounding_m_;
    case Shape::kRoom:
      return -boxDistance(p_S, half_size_m_);
    case Shape::kSphere:
      return p_S.norm() - half_size_m_.x();
    case Shape::kCylinder:
      return cylinderDistance(p_S, half_size_m_);
    case Shape::kCapsule:
      return capsuleDistance(p_S, half_size_m_);
    case Shape::kTorus:
      return torusDistance(p_S, half_size_m_);
    case Shape::kPlane:
      return p_S.z();
  }
  return std::numeric_limits<double>::infinity();
}

Vector3d Primitive::normal(const Vector3d& p_W) const {
  constexpr double kStep_m = 1e-6;
  Vector3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d step = kStep_m * Vector3d::Unit(axis);
    gradient[axis] = distance(p_W + step) - distance(p_W - step);
  }
  return gradient.normalized();
}

// Returns half the size of the box along the axes of S that holds the solid.
Vector3d Primitive::extentInS() const {
  const double radius_m = half_size_m_.x(), reach_m = half_size_m_.z();
  switch (shape_) {
    case Shape::kSphere:
      return Vector3d::Constant(radius_m);
    case Shape::kCapsule:
      return {radius_m, radius_m, radius_m + reach_m};
    case Shape::kTorus:
      return {radius_m + reach_m, radius_m + reach_m, reach_m};
    default:
      return half_size_m_;
  }
}

Primitive::Interval Primitive::hitInterval(const Vector3d& origin_S, const Vector3d& ray_S) const {
  if (shape_ == Shape::kPlane) {
    const double hit_m = -origin_S.z() / ray_S.z();
    return {hit_m, hit_m};
  }
  const Vector3d extent = extentInS();
  const Eigen::Array3d low = (-extent - origin_S).array() / ray_S.array();
  const Eigen::Array3d high = (extent - origin_S).array() / ray_S.array();
  const double enter_m = low.min(high).maxCoeff();
  const double leave_m = low.max(high).minCoeff();
  if (shape_ == Shape::kRoom) return {leave_m, leave_m};
  return {std::max(enter_m, 0.0), leave_m};
}

std::optional<double> Primitive::firstHit(const Vector3d& origin_W, const Vector3d& ray_W,
                                          double max_range_m) const {
  constexpr double kHit_m = 1e-6;
  constexpr int kMaxSteps = 400;
  const Vector3d origin_S = R_S_W_ * (origin_W - T_W_S_.translation());
  const Vector3d ray_S = R_S_W_ * ray_W;
  const Interval interval = hitInterval(origin_S, ray_S);
  const double end_m = std::min(interval.end_m + kHit_m, max_range_m);
  double range_m = interval.begin_m;
  for (int step = 0; step < kMaxSteps && range_m >= 0.0 && range_m < end_m; ++step) {
    const double distance_m = distanceInS(origin_S + range_m * ray_S);
    if (distance_m < kHit_m) return range_m;
    range_m += distance_m;
  }
  return std::nullopt;
}

void Primitive::moveOnGrid(const Vector3d& by_W) {
  constexpr double kGrid_m = 1.0 / (1 << 20);
  T_W_S_.translation() = by_W + kGrid_m * (T_W_S_.translation() / kGrid_m).array().round().matrix();
}

Primitive Primitive::moved(const Pose& T_W_moved) const {
  Primitive copy(shape_, T_W_moved * T_W_S_, half_size_m_, material_, rounding_m_);
  copy.T_L_W_ = T_L_W_ * T_W_moved.inverse();
  return copy;
}

Eigen::AlignedBox3d Primitive::boundingBox_W() const {
  constexpr double kMargin_m = 1e-5;  // more than what is called a hit
  const bool endless = shape_ == Shape::kRoom || shape_ == Shape::kPlane;
  const Vector3d extent = endless ? Vector3d::Constant(std::numeric_limits<double>::infinity())
                                  : Vector3d((T_W_S_.linear().cwiseAbs() * extentInS()).array() + kMargin_m);
  return {T_W_S_.translation() - extent, T_W_S_.translation() + extent};
}

Primitive box(const Vector3d& centre_W, const Vector3d& size_m, const Material& material, double yaw_rad,
              double rounding_m) {
  Pose T_W_S = Pose::Identity();
  T_W_S.translation() = centre_W;
  T_W_S.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  return Primitive(Shape::kBox, T_W_S, size_m / 2.0, material, rounding_m);
}

Primitive room(const Vector3d& centre_W, const Vector3d& size_m, const Material& material) {
  return Primitive(Shape::kRoom, poseWithZ(centre_W, Vector3d::UnitZ()), size_m / 2.0, material);
}

Primitive sphere(const Vector3d& centre_W, double radius_m, const Material& material) {
  return Primitive(Shape::kSphere, poseWithZ(centre_W, Vector3d::UnitZ()), Vector3d::Constant(radius_m),
                   material);
}

Primitive cylinder(const Vector3d& bottom_W, const Vector3d& top_W, double radius_m,
                   const Material& material) {
  return alongAxis(Shape::kCylinder, bottom_W, top_W, radius_m, material);
}

Primitive capsule(const Vector3d& from_W, const Vector3d& to_W, double radius_m, const Material& material) {
  return alongAxis(Shape::kCapsule, from_W, to_W, radius_m, material);
}

Primitive torus(const Vector3d& centre_W, const Vector3d& axis_W, double radius_m, double tube_radius_m,
                const Material& material) {
  return Primitive(Shape::kTorus, poseWithZ(centre_W, axis_W), {radius_m, radius_m, tube_radius_m}, material);
}

Primitive plane(const Vector3d& point_W, const Vector3d& normal_W, const Material& material) {
  return Primitive(Shape::kPlane, poseWithZ(point_W, normal_W), Vector3d::Zero(), material);
}

}  // namespace depth_fusion
