// How meshes are exported: in batches, into sinks.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <thread>

#include "depth_fusion/common/error.h"
#include "support/surface_mesh_fixture.h"

namespace depth_fusion {
namespace {

bool sameBytes(const TriangleMesh& a, const TriangleMesh& b) {
  return a.triangles == b.triangles && a.colors == b.colors && a.vertices.size() == b.vertices.size() &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(MeshVertex)) == 0;
}

TEST_F(SurfaceMesh, smallBatchesGiveTheSameBytes) {
  BlockMap map(compute(), parameters(4));
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

// Gives every colour byte of the pool a value of its own place.
void paintPool(BlockMap& map) {
  std::vector<uint8_t> bytes(map.layer(kColorLayer).bytes());
  for (size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<uint8_t>(i % 4 == 3 ? 9 : i * 2654435761u >> 13);
  map.layer(kColorLayer).write(bytes);
}

// Releases every other block and gives its slot to a block elsewhere.
void moveBlocks(BlockMap& map) {
  std::vector<int> released;
  std::vector<BlockIndex> elsewhere;
  for (const SlotTable::Block& block : map.slots().blocks()) {
    if (block.slot % 2 == 0) continue;
    released.push_back(block.slot);
    elsewhere.push_back(block.index + BlockIndex(0, 0, 8));
  }
  map.release(released);
  map.allocate(elsewhere);
}

class SnapshotOfBlockSize : public SurfaceMesh, public testing::WithParamInterface<int> {};

INSTANTIATE_TEST_SUITE_P(BlockSizes, SnapshotOfBlockSize, testing::Values(4, 8, 32));

TEST_P(SnapshotOfBlockSize, keepsTheSurfaceThatTheMapHad) {
  MapParameters colored = parameters(GetParam());
  colored.color = true;
  BlockMap map(compute(), colored);
  fillMap(map, sphere({0.001, 0.0, 0.0}, 0.06), Eigen::Vector3i::Constant(-16 / GetParam() - 1),
          32 / GetParam() + 2);
  paintPool(map);
  const TriangleMesh before = meshOf(map);
  const auto snapshot = map.snapshot({kTsdfLayer, kColorLayer});
  const auto colorless = map.snapshot({kTsdfLayer});
  map.layer(kTsdfLayer).fill(0x01010101, map.layer(kTsdfLayer).bytes());
  map.layer(kColorLayer).fill(0, map.layer(kColorLayer).bytes());
  moveBlocks(map);
  ASSERT_GT(before.triangles.size(), 1000u);
  ASSERT_EQ(before.colors.size(), before.vertices.size());
  EXPECT_FALSE(sameBytes(meshOf(map), before));
  EXPECT_TRUE(sameBytes(meshOf(*snapshot), before));
  TriangleMesh without_colors = before;
  without_colors.colors.clear();
  EXPECT_TRUE(sameBytes(meshOf(*colorless), without_colors));
}

TEST_F(SurfaceMesh, snapshotIsExportedBesideOtherWork) {
  BlockMap map(compute(), parameters(8));
  fillMap(map, sphere({0.001, 0.0, 0.0}, 0.08), Eigen::Vector3i::Constant(-4), 8);
  const TriangleMesh before = meshOf(map);
  const auto snapshot = map.snapshot({kTsdfLayer, kColorLayer});
  snapshot->offsets().read<int>(1);
  const auto queue = compute().anotherQueue();
  std::atomic<bool> done{false};
  std::thread mapping([&] {
    for (; !done; compute().finish()) map.layer(kTsdfLayer).fill(0x01010101, map.layer(kTsdfLayer).bytes());
  });
  for (int i = 0; i < 5; ++i) {
    TriangleMesh mesh;
    exportSurfaceMesh(*queue, *snapshot, mesh);
    EXPECT_TRUE(sameBytes(mesh, before));
  }
  done = true;
  mapping.join();
}

TEST_F(SurfaceMesh, snapshotTakesMemoryForTheUsedSlotsOnly) {
  BlockMap map(compute(), parameters(8));
  fillMap(map, sphere(Eigen::Vector3d::Zero(), 0.05), Eigen::Vector3i::Constant(-2), 4);
  const size_t slots = static_cast<size_t>(map.slots().bound());
  const auto snapshot = map.snapshot({kTsdfLayer, kColorLayer});
  EXPECT_EQ(snapshot->usage().blocks, map.usage().blocks);
  EXPECT_EQ(snapshot->usage().capacity, slots);
  EXPECT_EQ(snapshot->usage().pool_bytes, 4u * 32 * 32 * 32 + slots * (2 * 512 + 20));
}

TEST_F(SurfaceMesh, snapshotOfAnEmptyMapIsEmpty) {
  BlockMap map(compute(), parameters(8));
  map.reset({3.0, -2.0, 1.0});
  const auto snapshot = map.snapshot({kTsdfLayer, kColorLayer});
  EXPECT_EQ(snapshot->usage().blocks, 0u);
  EXPECT_EQ(snapshot->window().origin, map.window().origin);
  EXPECT_TRUE(meshOf(*snapshot).triangles.empty());
}

TEST_F(SurfaceMesh, parametersOutOfRangeAreErrors) {
  BlockMap map(compute(), parameters(8));
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
  BlockMap map(compute(), parameters(8));
  fillMap(map, sphere(Eigen::Vector3d::Zero(), 0.05), Eigen::Vector3i::Constant(-2), 4);
  FullSink sink;
  EXPECT_THROW(exportSurfaceMesh(compute(), map, sink), Error);
  EXPECT_GT(meshOf(map).triangles.size(), 0u);
}

TEST_F(SurfaceMesh, emptyMapGivesAnEmptyMesh) {
  BlockMap map(compute(), parameters(8));
  TriangleMesh mesh;
  const MeshStatistics statistics = exportSurfaceMesh(compute(), map, mesh);
  EXPECT_EQ(statistics.size.vertices, 0u);
  EXPECT_EQ(statistics.size.triangles, 0u);
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST_F(SurfaceMesh, reportsItsSize) {
  BlockMap map(compute(), parameters(8));
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
