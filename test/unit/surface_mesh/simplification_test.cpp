#include "depth_fusion/surface_mesh/simplification.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>

#include "support/expect_error.h"

namespace depth_fusion {
namespace {

constexpr uint32_t kSide = 100;

// A wall of 1 m x 1 m at z = 0.5 m, in colours that name the vertices.
TriangleMesh wall() {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < kSide * kSide; ++i) {
    const float x = static_cast<float>(i % kSide) / (kSide - 1);
    const float y = static_cast<float>(i / kSide) / (kSide - 1);
    mesh.vertices.push_back({{x, y, 0.5f}, {0.0f, 0.0f, 1.0f}});
    mesh.colors.push_back({static_cast<uint8_t>(i), static_cast<uint8_t>(i >> 8), 7});
    if (i % kSide == 0 || i < kSide) continue;
    mesh.triangles.push_back({i - kSide - 1, i - kSide, i});
    mesh.triangles.push_back({i - kSide - 1, i, i - 1});
  }
  return mesh;
}

// A sphere of radius 1 m: a cube of grids, drawn out, its vertices shared.
TriangleMesh ball(int cells) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, uint32_t> numbers;
  const auto vertex = [&](int axis, int side, int u, int v) {
    std::array<int, 3> p;
    p[axis] = side * cells;
    p[(axis + 1) % 3] = side * (2 * u - cells);
    p[(axis + 2) % 3] = 2 * v - cells;
    const auto [entry, is_new] = numbers.emplace(p, static_cast<uint32_t>(mesh.vertices.size()));
    const Eigen::Vector3f normal = Eigen::Vector3i(p[0], p[1], p[2]).cast<float>().normalized();
    if (is_new) mesh.vertices.push_back({normal, normal});
    return entry->second;
  };
  for (int face = 0; face < 6; ++face) {
    for (int cell = 0; cell < cells * cells; ++cell) {
      const int u = cell % cells, v = cell / cells, side = face < 3 ? 1 : -1;
      const uint32_t a = vertex(face % 3, side, u, v), b = vertex(face % 3, side, u + 1, v),
                     c = vertex(face % 3, side, u + 1, v + 1), d = vertex(face % 3, side, u, v + 1);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

Eigen::Vector3f corner(const TriangleMesh& mesh, const MeshTriangle& triangle, int i) {
  return mesh.vertices[triangle[i]].position_W;
}

double area_m2(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const MeshTriangle& t : mesh.triangles)
    area +=
        0.5 * (corner(mesh, t, 1) - corner(mesh, t, 0)).cross(corner(mesh, t, 2) - corner(mesh, t, 0)).norm();
  return area;
}

size_t openSides(const TriangleMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> sides;
  for (const MeshTriangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      ++sides[{t[i], t[(i + 1) % 3]}];
      --sides[{t[(i + 1) % 3], t[i]}];
    }
  }
  size_t open = 0;
  for (const auto& side : sides) open += side.second > 0;
  return open;
}

void expectSame(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.colors, b.colors);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (size_t i = 0; i < a.vertices.size(); ++i)
    EXPECT_EQ(a.vertices[i].position_W, b.vertices[i].position_W);
}

class Simplification : public testing::Test {
 protected:
  void SetUp() override {
    if (!canSimplify()) GTEST_SKIP() << "built without meshoptimizer";
  }
};

TEST_F(Simplification, wallStaysFlatAndWhole) {
  const TriangleMesh mesh = wall();
  const TriangleMesh fewer = simplified(mesh, 0.05);
  EXPECT_LE(fewer.triangles.size(), mesh.triangles.size() / 20);
  EXPECT_LT(fewer.vertices.size(), mesh.vertices.size() / 15);
  for (const MeshVertex& vertex : fewer.vertices) EXPECT_NEAR(vertex.position_W.z(), 0.5f, 1e-4f);
  EXPECT_NEAR(area_m2(fewer), 1.0, 1e-3);
}

TEST_F(Simplification, sphereStaysClosedAndNearIt) {
  const TriangleMesh mesh = ball(40);
  ASSERT_EQ(openSides(mesh), 0u);
  const TriangleMesh fewer = simplified(mesh, 0.1);
  EXPECT_LE(fewer.triangles.size(), mesh.triangles.size() / 10);
  EXPECT_GT(fewer.triangles.size(), mesh.triangles.size() / 12);
  EXPECT_EQ(openSides(fewer), 0u);
  for (const MeshTriangle& t : fewer.triangles) {
    const Eigen::Vector3f middle = (corner(fewer, t, 0) + corner(fewer, t, 1) + corner(fewer, t, 2)) / 3.0f;
    EXPECT_NEAR(middle.norm(), 1.0f, 0.015f);  // triangles of 0.15 m sag by 0.004 m
  }
}

TEST_F(Simplification, verticesKeepNormalsAndColors) {
  TriangleMesh mesh = wall();
  for (MeshVertex& vertex : mesh.vertices) vertex.normal_W = vertex.position_W.normalized();
  const TriangleMesh fewer = simplified(mesh, 0.2);
  ASSERT_EQ(fewer.colors.size(), fewer.vertices.size());
  for (size_t i = 0; i < fewer.vertices.size(); ++i) {
    const MeshVertex& original = mesh.vertices[fewer.colors[i][0] + 256u * fewer.colors[i][1]];
    EXPECT_EQ(fewer.vertices[i].position_W, original.position_W);
    EXPECT_EQ(fewer.vertices[i].normal_W, original.normal_W);
  }
}

TEST_F(Simplification, bordersStayIfTold) {
  const TriangleMesh fewer = simplified(wall(), 0.1, OpenBorders::kStay);
  size_t at_border = 0;
  for (const MeshVertex& vertex : fewer.vertices) {
    const auto p = vertex.position_W.head<2>().array();
    at_border += (p == 0.0f || p == 1.0f).any();
  }
  EXPECT_EQ(at_border, 4 * (kSide - 1));
  EXPECT_LT(fewer.triangles.size(), wall().triangles.size() / 8);
}

TEST(SimplificationRatio, ofOneChangesNothing) {
  expectSame(simplified(wall(), 1.0), wall());
  EXPECT_TRUE(simplified(TriangleMesh(), 1.0).triangles.empty());
}

TEST(SimplificationRatio, belowOneIsRefusedWithoutMeshoptimizer) {
  if (canSimplify()) GTEST_SKIP() << "built with meshoptimizer";
  expectError([] { simplified(wall(), 0.5); }, {"libmeshoptimizer-dev"});
}

TEST(SimplificationRatio, outOfRangeIsNamed) {
  for (const double ratio : {0.0, -0.5, 1.5, std::nan("")})
    expectError([&] { simplified(wall(), ratio); }, {std::to_string(ratio), "above 0 and at most 1"});
}

}  // namespace
}  // namespace depth_fusion
