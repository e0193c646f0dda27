#include "depth_fusion/surface_mesh/mesh_chunks.h"

#include <gtest/gtest.h>

#include "depth_fusion/pipeline/mapper.h"
#include "support/changing_map.h"
#include "support/chunk_viewer.h"
#include "support/expect_error.h"
#include "support/fusion_views.h"
#include "support/surface_mesh_fixture.h"

namespace depth_fusion {
namespace {

class MeshChunksTest : public SurfaceMesh {};

// All the blocks of the window that are not in the map come and go.
void fillWindowAndReleaseAgain(BlockMap& map) {
  const std::vector<int> offsets = map.offsets().read<int>(map.window().blockCount());
  const int n = map.window().blocks_per_axis;
  std::vector<BlockIndex> blocks;
  for (int i = 0; i < n * n * n; ++i) {
    const BlockIndex block = map.window().origin + BlockIndex(i % n, i / n % n, i / n / n);
    if (offsets[map.window().address(block)] == BLOCK_EMPTY) blocks.push_back(block);
  }
  map.allocate(blocks);
  std::vector<int> slots;
  for (const SlotTable::Block& block : map.slots().blocks()) {
    if (offsets[map.window().address(block.index)] == BLOCK_EMPTY) slots.push_back(block.slot);
  }
  map.offsets().write(offsets);
  map.release(slots);
}

struct Sizes {
  int block_size, blocks_per_chunk_axis;
};

class MeshChunksOfSize : public SurfaceMesh, public testing::WithParamInterface<Sizes> {};

INSTANTIATE_TEST_SUITE_P(Sizes, MeshChunksOfSize,
                         testing::Values(Sizes{4, 1}, Sizes{4, 3}, Sizes{8, 1}, Sizes{8, 2}, Sizes{8, 16},
                                         Sizes{16, 1}));

TEST_P(MeshChunksOfSize, areTheWholeSurfaceAfterEveryChange) {
  MapParameters colored = parameters(GetParam().block_size, 32);
  colored.color = true;
  BlockMap map(compute(), colored);
  ChangingMap scene(compute(), map);
  std::vector<uint8_t> paint(map.layer(kColorLayer).bytes());
  for (size_t i = 0; i < paint.size(); ++i)
    paint[i] = static_cast<uint8_t>(i % 4 == 3 ? 9 : i * 2654435761u >> 13);
  map.layer(kColorLayer).write(paint);
  MeshChunks chunks(compute(), map, {}, GetParam().blocks_per_chunk_axis);
  ChunkViewer viewer;
  for (const SignedDistance& surface :
       {sphere({0.001, 0.0, 0.0}, 0.07), sphere({0.004, 0.001, -0.002}, 0.0702),
        sphere({0.02, -0.03, 0.01}, 0.05), sphere({-0.05, -0.05, -0.05}, 0.03), nothing(),
        sphere({0.03, 0.03, 0.03}, 0.04)}) {
    scene.show(surface);
    viewer.follow(chunks);
    viewer.expectTheWholeSurface(map);
  }
  EXPECT_FALSE(viewer.shown().empty());
}

TEST_F(MeshChunksTest, smallBatchesGiveTheSame) {
  BlockMap map(compute(), parameters(4));
  ChangingMap scene(compute(), map);
  SurfaceMeshParameters small;
  small.max_batch_blocks = 9;
  MeshChunks chunks(compute(), map, small, 8);
  ChunkViewer viewer;
  scene.show(sphere({0.001, 0.0, 0.0}, 0.07));
  viewer.follow(chunks);
  viewer.expectTheWholeSurface(map);
}

TEST_F(MeshChunksTest, allAreReportedAgainToALateReader) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  scene.show(sphere({0.0, 0.0, 0.0}, 0.07));
  chunks.takeChanged(1000);
  chunks.noteAll();
  ChunkViewer late;
  late.follow(chunks);
  late.expectTheWholeSurface(map);
}

TEST_F(MeshChunksTest, resetForgetsThem) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  ChunkViewer viewer;
  scene.show(sphere({0.0, 0.0, 0.0}, 0.07));
  viewer.follow(chunks, 3);
  map.reset({0.0, 0.0, 0.0});
  chunks.follow();
  EXPECT_EQ(chunks.changedCount(), 0u);
  EXPECT_TRUE(chunks.takeChanged(1000).empty());
  ChunkViewer fresh;
  scene.show(sphere({0.03, 0.03, 0.03}, 0.04));
  fresh.follow(chunks);
  fresh.expectTheWholeSurface(map);
}

TEST_F(MeshChunksTest, whoHasMissedTooMuchShowsTheWholeSurfaceAllTheSame) {
  BlockMap map(compute(), parameters(4));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  ChunkViewer viewer;
  scene.show(sphere({-0.03, -0.03, -0.03}, 0.06));
  viewer.follow(chunks);
  scene.show(sphere({0.03, 0.03, 0.03}, 0.04));
  for (int round = 0; round < 4; ++round) fillWindowAndReleaseAgain(map);  // 32768 blocks
  viewer.follow(chunks);
  viewer.expectTheWholeSurface(map);
}

TEST_F(MeshChunksTest, parametersOutOfRangeAreErrors) {
  BlockMap map(compute(), parameters(8));
  expectError([&] { MeshChunks(compute(), map, {}, 0); }, {"at least one block"});
  SurfaceMeshParameters wrong;
  wrong.min_certainty = 256;
  expectError([&] { MeshChunks(compute(), map, wrong); }, {"min_certainty"});
}

// Fusion of a bumpy wall from several places, which is then taken away: free space is carved, and blocks are
// released. The map is told of it by the mapper, as long as somebody follows.
TEST(MeshChunksOfFusion, followEveryFrame) {
  BlockMap map(compute(), mapParameters());
  SubmapCollection submaps(map, {});
  Mapper mapper(compute(), map, submaps, {}, kCamera);
  MeshChunks chunks(compute(), map, {}, 4);
  ChunkViewer viewer;
  size_t released = 0;
  for (int frame = 0; frame < 14; ++frame) {
    RgbdFrame rgbd;
    rgbd.intrinsics = kCamera;
    rgbd.depth_unit_m = 1.0;
    rgbd.depth = frame < 5 ? bumpyDepth(1.2) : wallDepth(1.9);
    const View view = viewOf(rgbd.depth, somePose(0.1 * (frame % 3)));
    StageTimers timers;
    released += mapper.fuse(rgbd, frameOf(view), view.T_W_D, true, timers).fusion.blocks_released;
    viewer.follow(chunks);
    viewer.expectTheWholeSurface(map);
  }
  EXPECT_GT(released, 20u);
  EXPECT_FALSE(viewer.shown().empty());
}

}  // namespace
}  // namespace depth_fusion
