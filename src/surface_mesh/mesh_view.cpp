// Viewpoints for pictures of meshes.
#include <algorithm>
#include <cmath>
#include <map>

#include "depth_fusion/common/error.h"
#include "depth_fusion/common/percentile.h"
#include "depth_fusion/surface_mesh/mesh_picture.h"

namespace depth_fusion {
namespace {

constexpr double kSeenFraction = 0.99;
constexpr double kPi = 3.14159265358979323846;
constexpr size_t kVerticesLookedAt = 100000;

Eigen::Matrix3d turnedAbout(const Eigen::Vector3d& axis, double degrees) {
  return Eigen::AngleAxisd(degrees * kPi / 180.0, axis).toRotationMatrix();
}

// Returns the camera's orientation in the frame of the mesh.
const std::map<std::string, Eigen::Matrix3d>& orientations() {
  static const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  static const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  static const std::map<std::string, Eigen::Matrix3d> of_view = {
      {"auto", turnedAbout(x, -25.0)}, {"front", turnedAbout(x, 0.0)},   {"back", turnedAbout(y, 180.0)},
      {"left", turnedAbout(y, 90.0)},  {"right", turnedAbout(y, -90.0)}, {"top", turnedAbout(x, -90.0)},
      {"bottom", turnedAbout(x, 90.0)}};
  return of_view;
}

// Describes one direction of the picture, across or down, whose borders are at the slopes `low` and `high`.
// The points lie between the borders of a camera at (sideways, depth) if sideways - low * depth <= low_limit
// and sideways - high * depth >= high_limit.
struct Borders {
  double low, high;
  double low_limit, high_limit;

  double greatestDepth() const { return (low_limit - high_limit) / (high - low); }
  double sidewaysAt(double depth) const { return 0.5 * (low_limit + high_limit + (low + high) * depth); }
};

Borders bordersAround(const std::vector<double>& sideways, const std::vector<double>& depths, double low,
                      double high) {
  std::vector<double> from_low;
  std::vector<double> from_high;
  for (size_t i = 0; i < sideways.size(); ++i) {
    from_low.push_back(sideways[i] - low * depths[i]);
    from_high.push_back(sideways[i] - high * depths[i]);
  }
  const double outliers = (1.0 - kSeenFraction) / 4.0;
  return {low, high, percentile(from_low, outliers), percentile(from_high, 1.0 - outliers)};
}

}  // namespace

CameraIntrinsics pictureCamera(int width, int height, double horizontal_view_rad) {
  const double focal_px = width / (2.0 * std::tan(horizontal_view_rad / 2.0));
  return {width, height, focal_px, focal_px, (width - 1) / 2.0, (height - 1) / 2.0};
}

const std::vector<std::string>& viewNames() {
  static const std::vector<std::string> names = {"auto", "front", "back", "left", "right", "top", "bottom"};
  return names;
}

Pose viewOf(const TriangleMesh& mesh, const CameraIntrinsics& camera, const std::string& name) {
  const auto orientation = orientations().find(name);
  check(orientation != orientations().end(), "unknown view '" + name + "'");
  check(!mesh.vertices.empty(), "the mesh has no vertices to look at");
  const Eigen::Matrix3d R_C_W = orientation->second.transpose();
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> z;
  const size_t stride = 1 + mesh.vertices.size() / kVerticesLookedAt;
  for (size_t i = 0; i < mesh.vertices.size(); i += stride) {
    const Eigen::Vector3d p = R_C_W * mesh.vertices[i].position_W.cast<double>();
    x.push_back(p.x());
    y.push_back(p.y());
    z.push_back(p.z());
  }
  const Borders across =
      bordersAround(x, z, -camera.cx / camera.fx, (camera.width - 1 - camera.cx) / camera.fx);
  const Borders down =
      bordersAround(y, z, -camera.cy / camera.fy, (camera.height - 1 - camera.cy) / camera.fy);
  const double depth = std::min(across.greatestDepth(), down.greatestDepth());
  Pose T_W_C = Pose::Identity();
  T_W_C.linear() = orientation->second;
  T_W_C.translation() =
      orientation->second * Eigen::Vector3d(across.sidewaysAt(depth), down.sidewaysAt(depth), depth);
  return T_W_C;
}

}  // namespace depth_fusion
