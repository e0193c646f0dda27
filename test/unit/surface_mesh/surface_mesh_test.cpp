#include "depth_fusion/surface_mesh/surface_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "support/surface_mesh_fixture.h"

namespace depth_fusion {
namespace {

using DirectedSide = std::pair<uint32_t, uint32_t>;

SignedDistance plane(const Eigen::Vector3d& normal, double offset) {
  return [=](const Eigen::Vector3d& p) { return normal.normalized().dot(p) - offset; };
}

// Bumps about as small as a voxel: every cube case occurs, ambiguous faces and exact zeros among them.
SignedDistance bumps(double period_m) {
  return [=](const Eigen::Vector3d& p) {
    return 0.006 *
           (std::sin(p.x() / period_m) + std::sin(1.7 * p.y() / period_m) + std::sin(2.3 * p.z() / period_m));
  };
}

std::map<DirectedSide, int> directedSides(const TriangleMesh& mesh) {
  std::map<DirectedSide, int> sides;
  for (const MeshTriangle& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) ++sides[{triangle[i], triangle[(i + 1) % 3]}];
  }
  return sides;
}

// How many sides have no triangle on their other side, or more than one.
size_t openSides(const TriangleMesh& mesh) {
  const auto sides = directedSides(mesh);
  size_t open = 0;
  for (const auto& side : sides) {
    const auto opposite = sides.find({side.first.second, side.first.first});
    if (side.second != 1 || opposite == sides.end() || opposite->second != 1) ++open;
  }
  return open;
}

Eigen::Vector3d areaNormal(const TriangleMesh& mesh, const MeshTriangle& triangle) {
  const Eigen::Vector3d a = mesh.vertices[triangle[0]].position_W.cast<double>();
  const Eigen::Vector3d b = mesh.vertices[triangle[1]].position_W.cast<double>();
  const Eigen::Vector3d c = mesh.vertices[triangle[2]].position_W.cast<double>();
  return 0.5 * (b - a).cross(c - a);
}

// The edge of the grid that a vertex lies on: even numbers are voxels, odd ones lie between two.
std::array<long, 3> edgeOf(const MeshVertex& vertex, float voxel_size_m) {
  std::array<long, 3> edge;
  for (int axis = 0; axis < 3; ++axis) {
    const double vox = static_cast<double>(vertex.position_W[axis]) / voxel_size_m;
    const bool on_voxel = std::abs(vox - std::round(vox)) < 1e-4;
    edge[axis] = on_voxel ? 2 * std::lround(vox) : 2 * std::lround(std::floor(vox)) + 1;
  }
  return edge;
}

// The mesh with vertices in the order of their edges and triangles sorted, each from its least vertex on.
TriangleMesh canonical(const TriangleMesh& mesh, float voxel_size_m) {
  const auto key = [&](uint32_t i) { return edgeOf(mesh.vertices[i], voxel_size_m); };
  std::vector<uint32_t> order(mesh.vertices.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  std::vector<uint32_t> rank(order.size());
  TriangleMesh sorted;
  for (uint32_t i = 0; i < order.size(); ++i) {
    rank[order[i]] = i;
    sorted.vertices.push_back(mesh.vertices[order[i]]);
  }
  for (const MeshTriangle& triangle : mesh.triangles) {
    MeshTriangle t = {rank[triangle[0]], rank[triangle[1]], rank[triangle[2]]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    sorted.triangles.push_back(t);
  }
  std::sort(sorted.triangles.begin(), sorted.triangles.end());
  return sorted;
}

void expectSameMesh(const TriangleMesh& mesh, const TriangleMesh& reference, float voxel_size_m) {
  ASSERT_EQ(mesh.vertices.size(), reference.vertices.size());
  const TriangleMesh a = canonical(mesh, voxel_size_m);
  const TriangleMesh b = canonical(reference, voxel_size_m);
  EXPECT_TRUE(a.triangles == b.triangles);
  float position_error_m = 0.0f;
  float normal_error = 0.0f;
  for (size_t i = 0; i < a.vertices.size(); ++i) {
    position_error_m =
        std::max(position_error_m, (a.vertices[i].position_W - b.vertices[i].position_W).norm());
    normal_error = std::max(normal_error, (a.vertices[i].normal_W - b.vertices[i].normal_W).norm());
  }
  EXPECT_LT(position_error_m, 1e-6f);
  EXPECT_LT(normal_error, 1e-4f);
}

class SurfaceMeshOfBlockSize : public SurfaceMesh, public testing::WithParamInterface<int> {};

INSTANTIATE_TEST_SUITE_P(BlockSizes, SurfaceMeshOfBlockSize, testing::Values(4, 8, 16, 32));

TEST_P(SurfaceMeshOfBlockSize, sphereIsWatertightExactAndFacesOutward) {
  const int m = GetParam();
  const Eigen::Vector3d centre(0.003, -0.002, 0.001);
  const double radius = 0.12;
  BlockMap map(compute(), parameters(m));
  fillMap(map, sphere(centre, radius), Eigen::Vector3i::Constant(-32 / m), 64 / m);
  const TriangleMesh mesh = meshOf(map);

  ASSERT_GT(mesh.triangles.size(), 1000u);
  EXPECT_EQ(openSides(mesh), 0u);
  const size_t edges = directedSides(mesh).size() / 2;
  EXPECT_EQ(mesh.vertices.size() + mesh.triangles.size(), edges + 2);  // Euler characteristic 2
  // Half a distance step of quantisation at both ends of an edge, and the sphere's sag between them.
  const double tolerance_m = 0.02 / 127.0 * 0.75 + 0.005 * 0.005 / (8.0 * radius);
  for (const MeshVertex& vertex : mesh.vertices) {
    const Eigen::Vector3d from_centre = vertex.position_W.cast<double>() - centre;
    EXPECT_NEAR(from_centre.norm(), radius, tolerance_m);
    EXPECT_NEAR(vertex.normal_W.norm(), 1.0, 1e-5);
    EXPECT_GT(vertex.normal_W.cast<double>().dot(from_centre.normalized()), 0.999);
  }
  for (const MeshTriangle& triangle : mesh.triangles) {
    const Eigen::Vector3d normal = areaNormal(mesh, triangle);
    EXPECT_GT(normal.norm(), 0.0);
    EXPECT_GT(normal.normalized().dot(mesh.vertices[triangle[0]].normal_W.cast<double>()), 0.5);
  }
}

TEST_P(SurfaceMeshOfBlockSize, equalsTheReference) {
  const int m = GetParam();
  const int blocks = std::max(2, 32 / m);
  const Eigen::Vector3i first = Eigen::Vector3i::Constant(-blocks / 2);
  BlockMap map(compute(), parameters(m));
  for (const SignedDistance& distance :
       {bumps(0.0035), sphere({0.001, 0.002, -0.003}, 0.05), plane({0.3, -0.5, 1.0}, 0.004)}) {
    map.reset(Eigen::Vector3d::Zero());
    fillMap(map, distance, first, blocks);
    const DenseGrid grid = denseGrid(map.parameters(), distance, first, blocks);
    expectSameMesh(meshOf(map), ReferenceMarchingCubes(grid, map.parameters().voxel_size_m).mesh(),
                   map.parameters().voxel_size_m);
  }
}

TEST_P(SurfaceMeshOfBlockSize, windowThatWrapsAroundChangesNothing) {
  const int m = GetParam();
  const MapParameters narrow = parameters(m, 128 / m + 3);
  const double block_m = narrow.voxel_size_m * m;
  const Eigen::Vector3i middle(-37, 1001, 5);
  const SignedDistance ball =
      sphere((middle.cast<double>() + Eigen::Vector3d::Constant(0.5)) * block_m, 0.11);
  const Eigen::Vector3i first = middle - Eigen::Vector3i::Constant(32 / m);
  BlockMap map(compute(), narrow);
  map.reset(middle.cast<double>() * block_m);
  fillMap(map, ball, first, 64 / m + 1);
  const TriangleMesh mesh = meshOf(map);
  EXPECT_EQ(openSides(mesh), 0u);
  const DenseGrid grid = denseGrid(narrow, ball, first, 64 / m + 1);
  EXPECT_EQ(mesh.triangles.size(), ReferenceMarchingCubes(grid, narrow.voxel_size_m).mesh().triangles.size());
}

TEST_F(SurfaceMesh, bumpsHaveNoDegenerateTrianglesAndNoCracks) {
  const SignedDistance distance = bumps(0.0035);
  BlockMap map(compute(), parameters(8));
  fillMap(map, distance, Eigen::Vector3i::Constant(-2), 4);
  const TriangleMesh mesh = meshOf(map);
  for (const MeshTriangle& triangle : mesh.triangles) EXPECT_GT(areaNormal(mesh, triangle).norm(), 0.0);
  // Only the outside of the filled cube, voxels -16 to 15, may have open sides.
  const auto on_border = [](const MeshVertex& vertex) {
    const Eigen::Array3f vox = vertex.position_W.array() / 0.005f;
    return (vox < -15.999f).any() || (vox > 14.999f).any();
  };
  const auto sides = directedSides(mesh);
  for (const auto& side : sides) {
    EXPECT_EQ(side.second, 1);
    if (on_border(mesh.vertices[side.first.first]) && on_border(mesh.vertices[side.first.second])) continue;
    EXPECT_EQ(sides.count({side.first.second, side.first.first}), 1u);
  }
}

TEST_P(SurfaceMeshOfBlockSize, voxelsBelowTheMinimumWeightAreUnknown) {
  const int m = GetParam();
  const int blocks = std::max(2, 32 / m);
  const Eigen::Vector3i first = Eigen::Vector3i::Constant(-blocks / 2);
  const SignedDistance ball = sphere({0.001, 0.002, -0.003}, 0.05);
  const VoxelWeight weight = [](const Eigen::Vector3i& v) {
    return static_cast<uint8_t>(191 +
                                (static_cast<unsigned>(v.x() * 73 + v.y() * 179 + v.z() * 283) >> 3) % 32);
  };
  BlockMap map(compute(), parameters(m));
  fillMap(map, ball, first, blocks, weight);
  DenseGrid grid = denseGrid(map.parameters(), ball, first, blocks);
  grid.forEachVoxel([&](const Eigen::Vector3i& voxel) {
    if (weight(voxel) < 200) grid.at(voxel) = -128;
  });
  SurfaceMeshParameters parameters;
  parameters.min_certainty = 200;
  const TriangleMesh mesh = meshOf(map, parameters);
  EXPECT_GT(mesh.triangles.size(), 0u);
  expectSameMesh(mesh, ReferenceMarchingCubes(grid, map.parameters().voxel_size_m).mesh(),
                 map.parameters().voxel_size_m);
}

}  // namespace
}  // namespace depth_fusion
