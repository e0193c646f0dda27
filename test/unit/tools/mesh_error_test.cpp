// Mesh errors of meshes whose distance to the surface is known.
#include "tools/evaluation/mesh_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.141592653589793;
const Vector3d kCentre(0.3, -0.2, 1.0);
constexpr double kRadius_m = 0.5;

Scene sphereScene() { return Scene({sphere(kCentre, kRadius_m, {})}); }

void addQuad(TriangleMesh& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

// A globe of rings and sectors about the origin.
TriangleMesh globe(double radius_m, int rings, int sectors) {
  TriangleMesh mesh;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double polar = kPi * i / rings, azimuth = 2.0 * kPi * j / sectors;
      const Vector3d spoke(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                           std::cos(polar));
      mesh.vertices.push_back({(radius_m * spoke).cast<float>(), spoke.cast<float>()});
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const int next = (j + 1) % sectors;
      addQuad(mesh, i * sectors + j, (i + 1) * sectors + j, (i + 1) * sectors + next, i * sectors + next);
    }
  }
  return mesh;
}

Pose atCentre() {
  Pose T_W_M = Pose::Identity();
  T_W_M.translation() = kCentre;
  T_W_M.linear() = Eigen::AngleAxisd(0.4, Vector3d::UnitX()).toRotationMatrix();
  return T_W_M;
}

TEST(MeshError, OfAGlobeTooLargeIsTheExcess) {
  const MeshError error = compareMesh(globe(kRadius_m + 0.002, 200, 400), atCentre(), sphereScene(), 20000);
  EXPECT_NEAR(error.vertices_m.mean, 0.002, 1e-6);
  EXPECT_NEAR(error.vertices_m.max, 0.002, 1e-6);
  EXPECT_NEAR(error.surface_m.mean, 0.002, 5e-5);
  EXPECT_NEAR(error.area_m2, 4.0 * kPi * 0.502 * 0.502, 1e-3);
  EXPECT_EQ(error.surface_m.count, 20000u);
}

TEST(MeshError, PaintsFromBlueToRed) {
  TriangleMesh mesh;
  for (const float off_m : {0.0f, 0.005f, 0.01f, 0.02f}) {
    mesh.vertices.push_back({{float(kRadius_m) + off_m, 0, 0}, {1, 0, 0}});
  }
  Pose T_W_M = Pose::Identity();
  T_W_M.translation() = kCentre;
  paintError(mesh, T_W_M, sphereScene(), 0.01);
  ASSERT_EQ(mesh.colors.size(), 4u);
  EXPECT_GT(mesh.colors[0][2], mesh.colors[0][0]);
  EXPECT_GT(mesh.colors[1][1], 200);
  EXPECT_GT(mesh.colors[2][0], 2 * mesh.colors[2][2]);
  EXPECT_EQ(mesh.colors[3], mesh.colors[2]);
}

TEST(MeshError, OfCoarseTrianglesShowsOnTheSurfaceOnly) {
  const MeshError error = compareMesh(globe(kRadius_m, 8, 16), atCentre(), sphereScene(), 20000);
  EXPECT_LT(error.vertices_m.max, 1e-6);
  EXPECT_GT(error.surface_m.mean, 0.005);
}

// Two squares of equal area, one on the surface with many triangles and one 10 mm above it with two.
TEST(MeshError, OfTheSurfaceIsWeightedByArea) {
  TriangleMesh mesh;
  constexpr uint32_t kCells = 50;
  for (uint32_t i = 0; i <= kCells; ++i) {
    for (uint32_t j = 0; j <= kCells; ++j) {
      mesh.vertices.push_back({{i / float(kCells), j / float(kCells), 0.0f}, {0, 0, 1}});
    }
  }
  for (uint32_t i = 0; i < kCells; ++i) {
    for (uint32_t j = 0; j < kCells; ++j) {
      const uint32_t corner = i * (kCells + 1) + j;
      addQuad(mesh, corner, corner + kCells + 1, corner + kCells + 2, corner + 1);
    }
  }
  const uint32_t first = static_cast<uint32_t>(mesh.vertices.size());
  for (const auto& [x, y] : {std::pair{2.f, 0.f}, {3.f, 0.f}, {3.f, 1.f}, {2.f, 1.f}}) {
    mesh.vertices.push_back({{x, y, 0.01f}, {0, 0, 1}});
  }
  addQuad(mesh, first, first + 1, first + 2, first + 3);
  const Scene ground({plane({0, 0, 0}, {0, 0, 1}, {})});
  const MeshError error = compareMesh(mesh, Pose::Identity(), ground, 10000);
  EXPECT_NEAR(error.area_m2, 2.0, 1e-5);
  EXPECT_NEAR(error.surface_m.mean, 0.005, 1e-5);
  EXPECT_NEAR(error.surface_m.percentile95, 0.01, 1e-6);
  EXPECT_LT(error.vertices_m.mean, 1e-4);
}

TEST(MeshError, OfAnEmptyMeshIsRefused) {
  EXPECT_THROW(compareMesh(TriangleMesh(), Pose::Identity(), sphereScene()), Error);
}

}  // namespace
}  // namespace depth_fusion
