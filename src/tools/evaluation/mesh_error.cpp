#include "tools/evaluation/mesh_error.h"

#include <cmath>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> positionsOf(const TriangleMesh& mesh, const Pose& T_W_M) {
  std::vector<Vector3d> positions_W;
  positions_W.reserve(mesh.vertices.size());
  for (const MeshVertex& vertex : mesh.vertices) {
    positions_W.push_back(T_W_M * vertex.position_W.cast<double>());
  }
  return positions_W;
}

// Returns, for each triangle, the area of all triangles up to and with it.
std::vector<double> cumulativeAreas(const std::vector<Vector3d>& positions_W,
                                    const std::vector<MeshTriangle>& triangles) {
  std::vector<double> areas_m2;
  areas_m2.reserve(triangles.size());
  double sum_m2 = 0.0;
  for (const auto& [a, b, c] : triangles) {
    sum_m2 += (positions_W[b] - positions_W[a]).cross(positions_W[c] - positions_W[a]).norm() / 2.0;
    areas_m2.push_back(sum_m2);
  }
  return areas_m2;
}

// Returns the index-th point of a low-discrepancy sequence over a triangle (R2, folded at the diagonal).
Vector3d pointOn(const Vector3d& a, const Vector3d& b, const Vector3d& c, int index) {
  double s = std::fmod(0.5 + 0.7548776662466927 * index, 1.0);
  double t = std::fmod(0.5 + 0.5698402909980532 * index, 1.0);
  if (s + t > 1.0) {
    s = 1.0 - s;
    t = 1.0 - t;
  }
  return a + s * (b - a) + t * (c - a);
}

std::vector<Vector3d> sampleSurface(const std::vector<Vector3d>& positions_W,
                                    const std::vector<MeshTriangle>& triangles,
                                    const std::vector<double>& areas_m2, int samples) {
  std::vector<Vector3d> points_W;
  points_W.reserve(samples);
  size_t triangle = 0;
  for (int i = 0; i < samples; ++i) {
    const double area_m2 = areas_m2.back() * (i + 0.5) / samples;
    while (triangle + 1 < triangles.size() && areas_m2[triangle] < area_m2) ++triangle;
    const auto& [a, b, c] = triangles[triangle];
    points_W.push_back(pointOn(positions_W[a], positions_W[b], positions_W[c], i));
  }
  return points_W;
}

std::vector<double> distancesTo(const Scene& scene, const std::vector<Vector3d>& points_W) {
  std::vector<double> distances_m(points_W.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(points_W.size())), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) distances_m[i] = std::abs(scene.distance(points_W[i]));
  });
  return distances_m;
}

}  // namespace

MeshError compareMesh(const TriangleMesh& mesh, const Pose& T_W_M, const Scene& scene, int surface_samples) {
  check(!mesh.triangles.empty(), "the mesh has no triangles");
  const std::vector<Vector3d> positions_W = positionsOf(mesh, T_W_M);
  const std::vector<double> areas_m2 = cumulativeAreas(positions_W, mesh.triangles);
  MeshError error;
  error.triangles = mesh.triangles.size();
  error.area_m2 = areas_m2.back();
  error.vertices_m = statisticsOf(distancesTo(scene, positions_W));
  error.surface_m =
      statisticsOf(distancesTo(scene, sampleSurface(positions_W, mesh.triangles, areas_m2, surface_samples)));
  return error;
}

void paintError(TriangleMesh& mesh, const Pose& T_W_M, const Scene& scene, double full_scale_m) {
  const std::vector<double> distances_m = distancesTo(scene, positionsOf(mesh, T_W_M));
  cv::Mat colors;
  cv::Mat(distances_m).convertTo(colors, CV_8U, 255.0 / full_scale_m);
  cv::applyColorMap(colors, colors, cv::COLORMAP_TURBO);
  mesh.colors.clear();
  for (const cv::Vec3b& bgr : cv::Mat_<cv::Vec3b>(colors)) mesh.colors.push_back({bgr[2], bgr[1], bgr[0]});
}

}  // namespace depth_fusion
