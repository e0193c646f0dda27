#include "tools/simulation/walk.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace depth_fusion {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSpeed_m_s = 0.6;
constexpr double kEyeHeight_m = 1.4;
constexpr double kLookAhead_m = 1.2;
constexpr double kLookDown = 0.25;  // tangent
constexpr double kRounding_m = 1.0;
constexpr double kMount_m = 1.0, kMountAhead_m = 0.2, kMountLooksDown = 0.35;  // of a robot's camera

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

Gaze gazeAlong(const Route& route, const Sway& walk, const Sway& look) {
  const double along_m = kSpeed_m_s * walk.time_s();
  const Vector2d here = route.at(along_m), ahead = (route.at(along_m + kLookAhead_m) - here).normalized();
  const Vector2d left(-ahead.y(), ahead.x());
  const Vector2d eye = here + 0.04 * walk(0, 4.0) * left;
  const Vector2d target = eye + ahead + 0.1 * look(1, 5.0) * left;
  Gaze gaze;
  gaze.eye_W = {eye.x(), eye.y(), kEyeHeight_m + 0.04 * walk(2, 3.5)};
  gaze.target_W = {target.x(), target.y(), gaze.eye_W.z() - kLookDown + 0.06 * look(3, 4.3)};
  gaze.roll_rad = 0.03 * look(4, 4.1);
  return gaze;
}

Gaze gazeOfRobot(const Vector2d& base, const Vector2d& ahead) {
  const Vector2d eye = base + kMountAhead_m * ahead, target = eye + ahead;
  return {{eye.x(), eye.y(), kMount_m}, {target.x(), target.y(), kMount_m - kMountLooksDown}};
}

}  // namespace

Route::Route(const std::vector<Vector2d>& corners_m) {
  const size_t count = corners_m.size();
  Vector2d from = corners_m[0];
  for (size_t i = 1; i < count; ++i) {
    const Vector2d corner = corners_m[i], before = corner - corners_m[i - 1];
    const Vector2d after = corners_m[(i + 1) % count] - corner;
    const Vector2d in = before.normalized(), out = after.normalized();
    const double turn_rad = std::atan2(cross(in, out), in.dot(out));
    const double tangent = std::tan(std::abs(turn_rad) / 2.0);
    const double cut_m = std::min({kRounding_m * tangent, before.norm() / 2.0, after.norm() / 2.0});
    const double radius_m = cut_m / tangent;
    addStraight(from, corner - cut_m * in);
    legs_.push_back(
        {corner - cut_m * in, in, std::copysign(1.0 / radius_m, turn_rad), radius_m * std::abs(turn_rad)});
    from = corner + cut_m * out;
  }
  addStraight(from, corners_m[0]);
  for (const Leg& leg : legs_) length_m_ += leg.length_m;
}

void Route::addStraight(const Vector2d& from_m, const Vector2d& to_m) {
  legs_.push_back({from_m, (to_m - from_m).normalized(), 0.0, (to_m - from_m).norm()});
}

Vector2d Route::at(double along_m) const {
  along_m -= length_m_ * std::floor(along_m / length_m_);
  size_t i = 0;
  for (; i + 1 < legs_.size() && along_m > legs_[i].length_m; ++i) along_m -= legs_[i].length_m;
  const Leg& leg = legs_[i];
  if (leg.curvature_1_m == 0.0) return leg.begin_m + along_m * leg.direction;
  const double turned_rad = along_m * leg.curvature_1_m;
  const Vector2d left(-leg.direction.y(), leg.direction.x());
  return leg.begin_m +
         (std::sin(turned_rad) * leg.direction + (1.0 - std::cos(turned_rad)) * left) / leg.curvature_1_m;
}

Walk driveAlong(const std::string& name, const std::string& help, const std::vector<Vector2d>& corners_m) {
  const Route route(corners_m);
  const auto gaze = [route](const Sway& walk, const Sway&) {
    constexpr double kStep_m = 1e-4;
    const double along_m = kSpeed_m_s * walk.time_s();
    const Vector2d ahead = (route.at(along_m + kStep_m) - route.at(along_m - kStep_m)).normalized();
    return gazeOfRobot(route.at(along_m), ahead);
  };
  return {name, help, gaze, route.length_m() / kSpeed_m_s, true};
}

Pose cameraOnRobot() {
  const GazePath standing = [](const Sway&, const Sway&) { return gazeOfRobot({0.0, 0.0}, {1.0, 0.0}); };
  return handHeldPose(standing, 0, {}, 0.0, 0.0);
}

Walk walkAlong(const std::string& name, const std::string& help, const std::vector<Vector2d>& corners_m) {
  const Route route(corners_m);
  return {name, help, [route](const Sway& walk, const Sway& look) { return gazeAlong(route, walk, look); },
          route.length_m() / kSpeed_m_s};
}

}  // namespace depth_fusion
