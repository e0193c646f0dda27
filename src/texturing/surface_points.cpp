#include "texturing/surface_points.h"

#include <Eigen/Geometry>
#include <cmath>

namespace depth_fusion {
namespace {

// The k-th number of a sequence that fills [0, 1) evenly.
float evenly(size_t k, double step) {
  const double number = 0.5 + step * static_cast<double>(k);
  return static_cast<float>(number - std::floor(number));
}

}  // namespace

Eigen::Vector3f areaNormal(const TriangleMesh& mesh, const MeshTriangle& triangle) {
  const Eigen::Vector3f& first = mesh.vertices[triangle[0]].position_W;
  return (mesh.vertices[triangle[1]].position_W - first).cross(mesh.vertices[triangle[2]].position_W - first);
}

std::vector<PointOnMesh> pointsOn(const TriangleMesh& mesh, size_t count) {
  double area = 0.0;
  for (const MeshTriangle& t : mesh.triangles) area += static_cast<double>(areaNormal(mesh, t).norm());
  const double area_each = area / static_cast<double>(count);
  std::vector<PointOnMesh> points;
  double due = 0.5 * area_each;
  for (const MeshTriangle& t : mesh.triangles) {
    const Eigen::Vector3f normal = areaNormal(mesh, t);
    for (due -= static_cast<double>(normal.norm()); due < 0.0; due += area_each) {
      constexpr double kStepA = 0.7548776662466927, kStepB = 0.5698402909980532;  // of the plastic number
      const float root = std::sqrt(evenly(points.size(), kStepA)), along = evenly(points.size(), kStepB);
      points.push_back({(1.0f - root) * mesh.vertices[t[0]].position_W +
                            root * (1.0f - along) * mesh.vertices[t[1]].position_W +
                            root * along * mesh.vertices[t[2]].position_W,
                        normal.normalized()});
    }
  }
  return points;
}

}  // namespace depth_fusion
