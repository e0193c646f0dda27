// How meshes are exported: in batches, into sinks.
#include <gtest/gtest.h>

#include <cstring>

#include "depth_fusion/common/error.h"
#include "support/surface_mesh_fixture.h"

namespace depth_fusion {
namespace {

bool sameBytes(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles == b.triangles && a.vertices.size() == b.vertices.size() &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(MeshVertex)) == 0;
}

TEST_F(SurfaceMesh, smallBatchesGiveTheSameBytes) {
  BlockSparseMap map(compute(), parameters(4));
  fillMap(map, sphere({0.001, 0.0, 0.0}, 0.1), Eigen::Vector3i::Constant(-8), 16);
  TriangleMesh whole;
  TriangleMesh pieces;
  EXPECT_EQ(exportSurfaceMesh(compute(), map, whole).batches, 1u);
  SurfaceMeshParameters small;
  small.max_batch_blocks = 9;
  EXPECT_GT(exportSurfaceMesh(compute(), map, pieces, small).batches, 100u);
  ASSERT_GT(whole.triangles.size(), 1000u);
  EXPECT_TRUE(sameBytes(whole, pieces));
  EXPECT_TRUE(sameBytes(whole, meshOf(map)));
}

TEST_F(SurfaceMesh, parametersOutOfRangeAreErrors) {
  BlockSparseMap map(compute(), parameters(8));
  SurfaceMeshParameters parameters;
  parameters.min_certainty = 256;
  EXPECT_THROW(meshOf(map, parameters), Error);
  parameters = {};
  parameters.max_batch_blocks = 7;
  EXPECT_THROW(meshOf(map, parameters), Error);
}

TEST_F(SurfaceMesh, failingSinkIsAnError) {
  struct FullSink final : MeshSink {
    void begin(const MeshSize&) override {}
    void addVertices(const MeshVertex*, const MeshColor*, size_t) override { throw Error("full"); }
    void addTriangles(const MeshTriangle*, size_t) override {}
    void finish() override { FAIL() << "finished after a failure"; }
  };
  BlockSparseMap map(compute(), parameters(8));
  fillMap(map, sphere(Eigen::Vector3d::Zero(), 0.05), Eigen::Vector3i::Constant(-2), 4);
  FullSink sink;
  EXPECT_THROW(exportSurfaceMesh(compute(), map, sink), Error);
  EXPECT_GT(meshOf(map).triangles.size(), 0u);
}

TEST_F(SurfaceMesh, emptyMapGivesAnEmptyMesh) {
  BlockSparseMap map(compute(), parameters(8));
  TriangleMesh mesh;
  const MeshStatistics statistics = exportSurfaceMesh(compute(), map, mesh);
  EXPECT_EQ(statistics.size.vertices, 0u);
  EXPECT_EQ(statistics.size.triangles, 0u);
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST_F(SurfaceMesh, reportsItsSize) {
  BlockSparseMap map(compute(), parameters(8));
  fillMap(map, sphere(Eigen::Vector3d::Zero(), 0.05), Eigen::Vector3i::Constant(-2), 4);
  TriangleMesh mesh;
  const MeshStatistics statistics = exportSurfaceMesh(compute(), map, mesh);
  EXPECT_EQ(statistics.size.vertices, mesh.vertices.size());
  EXPECT_EQ(statistics.size.triangles, mesh.triangles.size());
  EXPECT_EQ(statistics.blocks, map.usage().blocks);
  EXPECT_LT(statistics.device_bytes, size_t{64} << 20);
}

}  // namespace
}  // namespace depth_fusion
