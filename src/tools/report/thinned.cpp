// Meshes of fewer vertices, evenly.
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "tools/report/web_model.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

// The mean of the vertices in a cube.
struct Cluster {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  float count = 0.0f;
};

// The cubes' numbers, in the order of the vertices that come first, and the number of each vertex's cube.
struct Clustering {
  std::vector<uint32_t> of_vertex;
  uint32_t count = 0;
};

uint64_t cubeOf(const Eigen::Vector3f& p_W, float edge_m) {
  uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<int64_t>(std::floor(p_W[axis] / edge_m));
    key = key << 21 | (static_cast<uint64_t>(cell) & 0x1fffffu);
  }
  return key;
}

Clustering clusteringOf(const TriangleMesh& mesh, float edge_m) {
  Clustering clustering;
  std::unordered_map<uint64_t, uint32_t> numbers;
  for (const MeshVertex& vertex : mesh.vertices) {
    const auto [cube, is_new] = numbers.try_emplace(cubeOf(vertex.position_W, edge_m), clustering.count);
    if (is_new) ++clustering.count;
    clustering.of_vertex.push_back(cube->second);
  }
  return clustering;
}

// A surface meets a number of cubes that falls with the square of their edge.
Clustering fittingClustering(const TriangleMesh& mesh, size_t max_vertices) {
  float edge_m = 0.0f;
  for (const MeshTriangle& t : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[t[0]].position_W;
    edge_m = std::max(edge_m, (mesh.vertices[t[1]].position_W - a).norm());
  }
  edge_m = std::max(edge_m, 1e-6f);
  while (true) {
    Clustering clustering = clusteringOf(mesh, edge_m);
    if (clustering.count <= max_vertices) return clustering;
    edge_m *= 1.01f * std::sqrt(static_cast<float>(clustering.count) / static_cast<float>(max_vertices));
  }
}

std::vector<Cluster> meansOf(const TriangleMesh& mesh, const Clustering& clustering) {
  std::vector<Cluster> clusters(clustering.count);
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    Cluster& cluster = clusters[clustering.of_vertex[i]];
    cluster.position += mesh.vertices[i].position_W;
    cluster.normal += mesh.vertices[i].normal_W;
    if (!mesh.colors.empty())
      cluster.color += Eigen::Vector3f(mesh.colors[i][0], mesh.colors[i][1], mesh.colors[i][2]);
    cluster.count += 1.0f;
  }
  return clusters;
}

MeshColor colorOf(const Cluster& cluster) {
  MeshColor color;
  for (size_t i = 0; i < 3; ++i)
    color[i] = static_cast<uint8_t>(std::lround(cluster.color[static_cast<int>(i)] / cluster.count));
  return color;
}

}  // namespace

TriangleMesh thinned(const TriangleMesh& mesh, size_t max_vertices) {
  if (mesh.vertices.size() <= max_vertices || mesh.triangles.empty()) return mesh;
  const Clustering clustering = fittingClustering(mesh, max_vertices);
  const std::vector<Cluster> clusters = meansOf(mesh, clustering);
  TriangleMesh result;
  std::vector<uint32_t> numbers(clusters.size(), kNone);  // only what triangles use gets one
  for (const MeshTriangle& t : mesh.triangles) {
    MeshTriangle triangle;
    for (size_t i = 0; i < 3; ++i) triangle[i] = clustering.of_vertex[t[i]];
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    for (uint32_t& vertex : triangle) {
      const Cluster& cluster = clusters[vertex];
      uint32_t& number = numbers[vertex];
      if (number == kNone) {
        number = static_cast<uint32_t>(result.vertices.size());
        result.vertices.push_back({cluster.position / cluster.count, cluster.normal.normalized()});
        if (!mesh.colors.empty()) result.colors.push_back(colorOf(cluster));
      }
      vertex = number;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

}  // namespace depth_fusion
