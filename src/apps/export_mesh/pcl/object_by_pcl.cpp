#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/sac_segmentation.h>
#include <pcl/surface/poisson.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "apps/export_mesh/object.h"
#include "depth_fusion/common/error.h"
#include "surface_mesh/mesh_normals.h"

namespace depth_fusion {
namespace {

pcl::PointCloud<pcl::PointNormal>::Ptr pointsOf(const TriangleMesh& mesh) {
  auto points = pcl::make_shared<pcl::PointCloud<pcl::PointNormal>>();
  for (const MeshVertex& vertex : mesh.vertices) {
    pcl::PointNormal point;
    point.getVector3fMap() = vertex.position_W;
    point.getNormalVector3fMap() = vertex.normal_W;
    points->push_back(point);
  }
  return points;
}

// The edges' median.
double edgeOf(const TriangleMesh& mesh) {
  std::vector<double> edges_m;
  for (const MeshTriangle& t : mesh.triangles)
    edges_m.push_back(
        static_cast<double>((mesh.vertices[t[0]].position_W - mesh.vertices[t[1]].position_W).norm()));
  std::nth_element(edges_m.begin(), edges_m.begin() + static_cast<std::ptrdiff_t>(edges_m.size() / 2),
                   edges_m.end());
  return edges_m[edges_m.size() / 2];
}

// How much larger than the mesh the octree's cube is: where it was not seen, the surface bulges.
constexpr double kScale = 2.0;

// The octree is so deep that its cells are as large as the mesh's edges.
int depthFor(const TriangleMesh& mesh) {
  constexpr int kLeast = 5, kMost = 11;
  Eigen::AlignedBox3f box;
  for (const MeshVertex& vertex : mesh.vertices) box.extend(vertex.position_W);
  const double cells = kScale * static_cast<double>(box.sizes().maxCoeff()) / edgeOf(mesh);
  return std::clamp(static_cast<int>(std::lround(std::log2(cells))), kLeast, kMost);
}

// The colours of the vertices of the other mesh that are nearest.
void takeColors(const TriangleMesh& from, const pcl::PointCloud<pcl::PointNormal>::Ptr& points,
                TriangleMesh& mesh) {
  if (from.colors.empty()) return;
  pcl::KdTreeFLANN<pcl::PointNormal> tree;
  tree.setInputCloud(points);
  for (const MeshVertex& vertex : mesh.vertices) {
    pcl::PointNormal point;
    point.getVector3fMap() = vertex.position_W;
    std::vector<int> nearest(1);
    std::vector<float> squared(1);
    tree.nearestKSearch(point, 1, nearest, squared);
    mesh.colors.push_back(from.colors[static_cast<size_t>(nearest.front())]);
  }
}

}  // namespace

Eigen::Vector4f groundOf(const TriangleMesh& mesh) {
  constexpr double kReach = 2.0;  // of the mesh's edges, to both sides
  pcl::SACSegmentation<pcl::PointNormal> segmentation;
  segmentation.setInputCloud(pointsOf(mesh));
  segmentation.setModelType(pcl::SACMODEL_PLANE);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setDistanceThreshold(kReach * edgeOf(mesh));
  segmentation.setMaxIterations(1000);
  segmentation.setOptimizeCoefficients(true);
  pcl::PointIndices inliers;
  pcl::ModelCoefficients plane;
  segmentation.segment(inliers, plane);
  check(plane.values.size() == 4, "there is no plane that could be the ground");
  Eigen::Vector4f ground(plane.values[0], plane.values[1], plane.values[2], plane.values[3]);
  float above = 0.0f;
  for (const MeshVertex& vertex : mesh.vertices) above += ground.dot(vertex.position_W.homogeneous());
  return above < 0.0f ? Eigen::Vector4f(-ground) : ground;
}

TriangleMesh closedModel(const TriangleMesh& mesh) {
  const auto points = pointsOf(mesh);
  pcl::Poisson<pcl::PointNormal> poisson;
  poisson.setInputCloud(points);
  poisson.setScale(static_cast<float>(kScale));
  poisson.setDepth(depthFor(mesh));
  poisson.setSolverDivide(std::min(depthFor(mesh), 8));
  poisson.setIsoDivide(std::min(depthFor(mesh), 8));
  pcl::PointCloud<pcl::PointNormal> vertices;
  std::vector<pcl::Vertices> polygons;
  poisson.reconstruct(vertices, polygons);
  TriangleMesh closed;
  for (const auto& vertex : vertices)
    closed.vertices.push_back({vertex.getVector3fMap(), Eigen::Vector3f::Zero()});
  for (const pcl::Vertices& polygon : polygons) {
    const auto& corners = polygon.vertices;
    check(corners.size() == 3, "the closed model has a face that is no triangle");
    closed.triangles.push_back({static_cast<uint32_t>(corners[0]), static_cast<uint32_t>(corners[1]),
                                static_cast<uint32_t>(corners[2])});
  }
  setNormals(closed);
  takeColors(mesh, points, closed);
  return closed;
}

}  // namespace depth_fusion
