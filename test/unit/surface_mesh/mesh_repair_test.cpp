#include "depth_fusion/surface_mesh/mesh_repair.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>

#include "depth_fusion/surface_mesh/mesh_finish.h"
#include "depth_fusion/surface_mesh/simplification.h"
#include "support/expect_error.h"

namespace depth_fusion {
namespace {

// A box's surface in grids of 1 cm, from a corner on, closed but for the cells at its top that are open.
TriangleMesh boxOf(int cells, const Eigen::Vector3f& corner_m,
                   const std::vector<std::array<int, 2>>& open = {}) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, uint32_t> numbers;
  const auto vertex = [&](int axis, int layer, int u, int v) {
    std::array<int, 3> p{};
    p[axis] = layer;
    p[(axis + 1) % 3] = u;
    p[(axis + 2) % 3] = v;
    const auto [entry, is_new] = numbers.emplace(p, static_cast<uint32_t>(mesh.vertices.size()));
    const Eigen::Vector3f offset = Eigen::Vector3i(p[0], p[1], p[2]).cast<float>() * 0.01f;
    if (is_new) mesh.vertices.push_back({corner_m + offset, Eigen::Vector3f::UnitZ()});
    return entry->second;
  };
  for (int face = 0; face < 6; ++face) {
    const bool top = face == 2;
    for (int cell = 0; cell < cells * cells; ++cell) {
      const int u = cell % cells, v = cell / cells, layer = face < 3 ? cells : 0;
      if (top && std::count(open.begin(), open.end(), std::array<int, 2>{u, v}) > 0) continue;
      uint32_t a = vertex(face % 3, layer, u, v), b = vertex(face % 3, layer, u + 1, v),
               c = vertex(face % 3, layer, u + 1, v + 1), d = vertex(face % 3, layer, u, v + 1);
      if (face >= 3) std::swap(b, d);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

TriangleMesh joinedMeshes(TriangleMesh mesh, const TriangleMesh& other) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const MeshTriangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return mesh;
}

// How often each edge is used in its direction; a closed, oriented surface has each once, and its opposite.
void expectClosedManifold(const TriangleMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const MeshTriangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1) << edge.first << " " << edge.second;
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u) << edge.first << " " << edge.second;
  }
}

double volume_m3(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const MeshTriangle& t : mesh.triangles) {
    const auto p = [&](int i) { return mesh.vertices[t[i]].position_W.cast<double>().eval(); };
    volume += p(0).dot(p(1).cross(p(2))) / 6.0;
  }
  return volume;
}

TEST(MeshRepair, islandsBelowTheSizeGo) {
  const TriangleMesh large = boxOf(10, {0, 0, 0}), small = boxOf(2, {1, 0, 0});
  const IslandRemoval none = withoutIslands(joinedMeshes(large, small), 0.03);
  EXPECT_EQ(none.removed, 0u);
  EXPECT_EQ(none.mesh.triangles.size(), large.triangles.size() + small.triangles.size());
  const IslandRemoval one = withoutIslands(joinedMeshes(large, small), 0.04);  // 2 cm cubed is 3.5 cm across
  EXPECT_EQ(one.removed, 1u);
  EXPECT_EQ(one.mesh.triangles.size(), large.triangles.size());
  EXPECT_EQ(one.mesh.vertices.size(), large.vertices.size());
  EXPECT_TRUE(withoutIslands(joinedMeshes(large, small), 1.0).mesh.triangles.empty());
}

TEST(MeshRepair, holesUpToTheSizeAreClosedFlat) {
  const TriangleMesh whole = boxOf(8, {0, 0, 0});
  expectClosedManifold(whole);
  const std::vector<std::array<int, 2>> open = {{2, 2}, {3, 2}, {3, 3}, {6, 6}};  // an angle, and a square
  const HoleClosing result = withHolesClosed(boxOf(8, {0, 0, 0}, open), 0.05);
  EXPECT_EQ(result.closed, 2u);
  EXPECT_EQ(result.left, 0u);
  expectClosedManifold(result.mesh);
  EXPECT_EQ(result.mesh.triangles.size(), whole.triangles.size());
  EXPECT_NEAR(volume_m3(result.mesh), volume_m3(whole), 1e-9);
}

TEST(MeshRepair, holesThatMeetAtAVertexAreClosedOneByOne) {
  const HoleClosing result = withHolesClosed(boxOf(8, {0, 0, 0}, {{2, 2}, {3, 3}}), 0.05);
  EXPECT_EQ(result.closed, 2u);
  expectClosedManifold(result.mesh);
}

TEST(MeshRepair, largerHolesStay) {
  const TriangleMesh mesh = boxOf(8, {0, 0, 0}, {{2, 2}, {3, 2}});
  const HoleClosing result = withHolesClosed(mesh, 0.02);  // it is 2.2 cm across
  EXPECT_EQ(result.left, 1u);
  EXPECT_EQ(result.mesh.triangles, mesh.triangles);
}

TEST(MeshFinish, doesAllInOrderAndSaysIt) {
  if (!canSimplify()) GTEST_SKIP() << "built without meshoptimizer";
  MeshFinish finish;
  EXPECT_FALSE(finish.changesMesh());
  finish.min_island_m = 0.04;
  finish.max_hole_m = 0.05;
  finish.max_triangles = 100;
  const FinishedMesh result =
      finished(joinedMeshes(boxOf(10, {0, 0, 0}, {{4, 4}}), boxOf(2, {1, 0, 0})), finish);
  EXPECT_EQ(result.remark, "1 islands removed, 1 holes closed, 0 left open, " +
                               std::to_string(result.mesh.triangles.size()) + " of 1200 triangles kept");
  EXPECT_LE(result.mesh.triangles.size(), 100u);
  expectClosedManifold(result.mesh);
  EXPECT_NEAR(volume_m3(result.mesh), 1e-3, 1e-7);
}

TEST(MeshFinish, errorBoundsSimplification) {
  if (!canSimplify()) GTEST_SKIP() << "built without meshoptimizer";
  TriangleMesh ball = boxOf(40, {-0.2f, -0.2f, -0.2f});
  for (MeshVertex& vertex : ball.vertices) vertex.position_W.normalize();
  size_t before = ball.triangles.size();
  for (const double max_error_m : {0.0005, 0.005, 0.05}) {
    const TriangleMesh mesh = finished(ball, {0.0, 0.0, 1.0, 0, max_error_m}).mesh;
    EXPECT_LT(mesh.triangles.size(), before) << max_error_m;
    before = mesh.triangles.size();
    double sum_m = 0.0;
    for (const MeshTriangle& t : mesh.triangles) {
      const Eigen::Vector3f middle =
          (mesh.vertices[t[0]].position_W + mesh.vertices[t[1]].position_W + mesh.vertices[t[2]].position_W) /
          3.0f;
      sum_m += 1.0 - static_cast<double>(middle.norm());
      EXPECT_NEAR(static_cast<double>(middle.norm()), 1.0, 4.0 * max_error_m);
    }
    EXPECT_LT(sum_m / static_cast<double>(mesh.triangles.size()), 1.5 * max_error_m);
  }
}

TEST(MeshFinish, nonsenseIsNamed) {
  expectError([] { finished({}, {-1.0}); }, {"island", "-1"});
  expectError([] { finished({}, {0.0, 0.0, 0.0}); }, {"share", "above 0"});
}

}  // namespace
}  // namespace depth_fusion
