// Which mesh chunks are told of, and in which order.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/changing_map.h"
#include "support/chunk_viewer.h"
#include "support/surface_mesh_fixture.h"

namespace depth_fusion {
namespace {

class ChangedChunks : public SurfaceMesh {};

TEST_F(ChangedChunks, comeNearestFirstIfSorted) {
  BlockMap map(compute(), parameters(8, 32));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 1);
  scene.show(sphere({0.0, 0.0, 0.0}, 0.07));
  chunks.follow();
  const Eigen::Vector3d point_W(0.1, 0.02, -0.03);
  chunks.sortChanged(point_W);
  const double edge_m = 8.0 * static_cast<double>(map.parameters().voxel_size_m);
  double last_m = 0.0;
  size_t taken = 0;
  while (chunks.changedCount() > 0) {
    for (const MeshChunk& chunk : chunks.takeChanged(1)) {
      const Eigen::Vector3d centre(chunk.index[0] + 0.5, chunk.index[1] + 0.5, chunk.index[2] + 0.5);
      const double distance_m = (edge_m * centre - point_W).norm();
      EXPECT_GE(distance_m, last_m - 1e-9);
      last_m = distance_m;
      ++taken;
    }
  }
  EXPECT_GT(taken, 20u);
}

TEST_F(ChangedChunks, surfaceThatIsGoneIsReportedOnce) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  ChunkViewer viewer;
  scene.show(sphere({0.0, 0.0, 0.0}, 0.07));
  viewer.follow(chunks);
  const ChunkIndices shown = viewer.shown();
  EXPECT_GT(shown.size(), 7u);
  scene.show(nothing());
  EXPECT_EQ(viewer.follow(chunks), shown);
  EXPECT_TRUE(viewer.shown().empty());
  EXPECT_TRUE(viewer.follow(chunks).empty());
}

TEST_F(ChangedChunks, onlyThoseThatChangedAreReported) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  ChunkViewer viewer;
  const SignedDistance ball = sphere({0.0, 0.0, 0.0}, 0.07);
  const SignedDistance wart = sphere({0.07, 0.02, 0.02}, 0.006);
  scene.show(ball);
  EXPECT_GT(viewer.follow(chunks).size(), 7u);
  EXPECT_TRUE(viewer.follow(chunks).empty());
  scene.show([&](const Eigen::Vector3d& p) { return std::min(ball(p), wart(p)); });
  // Blocks of 4 cm: the wart's truncation band lies in x from 4 to 12 cm, and in y and z from -4 to 4 cm.
  for (const MeshChunkIndex& index : viewer.follow(chunks)) {
    EXPECT_TRUE(index[0] == 0 || index[0] == 1) << index[0];
    EXPECT_TRUE(index[1] >= -1 && index[1] <= 0 && index[2] >= -1 && index[2] <= 0)
        << index[1] << " " << index[2];
  }
  viewer.expectTheWholeSurface(map);
}

TEST_F(ChangedChunks, oldestChangeComesFirst) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  ChunkViewer viewer;
  scene.show(sphere({-0.08, -0.08, -0.08}, 0.03));
  chunks.follow();
  const size_t first = chunks.changedCount();
  const ChunkIndices near_first = [&] {
    MeshChunks others(compute(), map, {}, 2);
    return ChunkViewer().follow(others);
  }();
  const SignedDistance both = [](const Eigen::Vector3d& p) {
    return std::min(sphere({-0.08, -0.08, -0.08}, 0.03)(p), sphere({0.08, 0.08, 0.08}, 0.03)(p));
  };
  scene.show(both);
  EXPECT_EQ(viewer.follow(chunks, first), near_first);
  EXPECT_FALSE(near_first.empty());
  while (chunks.changedCount() > 0) {
    const size_t before = chunks.changedCount();
    viewer.follow(chunks, 2);
    EXPECT_EQ(before - chunks.changedCount(), std::min<size_t>(before, 2));
  }
  viewer.expectTheWholeSurface(map);
}

TEST_F(ChangedChunks, takenInTurnTheyAllComeAgain) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  scene.show(sphere({0.0, 0.0, 0.0}, 0.07));
  const size_t count = chunks.takeChanged(1000).size();
  ChunkViewer unnoticed;
  for (size_t seen = 0; seen < count; seen += 3) {
    chunks.noteNext(std::min<size_t>(3, count - seen));
    EXPECT_EQ(unnoticed.follow(chunks).size(), std::min<size_t>(3, count - seen));
  }
  unnoticed.expectTheWholeSurface(map);
  map.reset({0.0, 0.0, 0.0});
  chunks.follow();
  chunks.noteNext(3);
  EXPECT_EQ(chunks.changedCount(), 0u);
}

}  // namespace
}  // namespace depth_fusion
