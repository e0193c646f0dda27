#include "depth_fusion/surface_mesh/mesh_chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "depth_fusion/pipeline/mapper.h"
#include "support/changing_map.h"
#include "support/expect_error.h"
#include "support/fusion_views.h"
#include "support/surface_mesh_fixture.h"

namespace depth_fusion {
namespace {

using ChunkIndices = std::set<MeshChunkIndex>;

// A vertex with everything that belongs to it.
struct Corner {
  std::array<float, 6> vertex;
  MeshColor color;
  bool operator<(const Corner& other) const {
    return std::tie(vertex, color) < std::tie(other.vertex, other.color);
  }
  bool operator==(const Corner& other) const { return vertex == other.vertex && color == other.color; }
};
using Triangles = std::vector<std::array<Corner, 3>>;

Corner cornerOf(const TriangleMesh& mesh, uint32_t vertex) {
  Corner corner{};
  std::memcpy(corner.vertex.data(), &mesh.vertices.at(vertex), sizeof(MeshVertex));
  if (!mesh.colors.empty()) corner.color = mesh.colors.at(vertex);
  return corner;
}

void addTriangles(const TriangleMesh& mesh, Triangles& triangles) {
  for (const MeshTriangle& t : mesh.triangles) {
    std::array<Corner, 3> corners = {cornerOf(mesh, t[0]), cornerOf(mesh, t[1]), cornerOf(mesh, t[2])};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.push_back(corners);
  }
}

// What a viewer has that is told of the changes.
class Viewer {
 public:
  // Returns the chunks that it was told of.
  ChunkIndices follow(MeshChunks& chunks, size_t max_count = SIZE_MAX) {
    ChunkIndices told;
    for (MeshChunk& chunk : chunks.takeChanged(max_count)) {
      EXPECT_TRUE(told.insert(chunk.index).second) << "told of twice";
      if (chunk.mesh.triangles.empty()) {
        EXPECT_EQ(meshes_.erase(chunk.index), 1u) << "is gone but was never there";
      } else {
        meshes_[chunk.index] = std::move(chunk.mesh);
      }
    }
    return told;
  }

  ChunkIndices shown() const {
    ChunkIndices indices;
    for (const auto& entry : meshes_) indices.insert(entry.first);
    return indices;
  }

  void expectTheWholeSurface(BlockMap& map, const SurfaceMeshParameters& parameters = {}) const {
    TriangleMesh whole;
    exportSurfaceMesh(compute(), map, whole, parameters);
    Triangles expected, seen;
    addTriangles(whole, expected);
    for (const auto& entry : meshes_) {
      addTriangles(entry.second, seen);
      expectNoUnusedVertex(entry.second);
    }
    std::sort(expected.begin(), expected.end());
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(seen.size(), expected.size());
    EXPECT_TRUE(seen == expected);
  }

 private:
  static void expectNoUnusedVertex(const TriangleMesh& mesh) {
    std::vector<bool> used(mesh.vertices.size(), false);
    for (const MeshTriangle& triangle : mesh.triangles) {
      for (const uint32_t vertex : triangle) used.at(vertex) = true;
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
  }

  std::map<MeshChunkIndex, TriangleMesh> meshes_;
};

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
  Viewer viewer;
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

TEST_F(MeshChunksTest, comeNearestFirstIfSorted) {
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

TEST_F(MeshChunksTest, smallBatchesGiveTheSame) {
  BlockMap map(compute(), parameters(4));
  ChangingMap scene(compute(), map);
  SurfaceMeshParameters small;
  small.max_batch_blocks = 9;
  MeshChunks chunks(compute(), map, small, 8);
  Viewer viewer;
  scene.show(sphere({0.001, 0.0, 0.0}, 0.07));
  viewer.follow(chunks);
  viewer.expectTheWholeSurface(map);
}

TEST_F(MeshChunksTest, surfaceThatIsGoneIsReportedOnce) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  Viewer viewer;
  scene.show(sphere({0.0, 0.0, 0.0}, 0.07));
  viewer.follow(chunks);
  const ChunkIndices shown = viewer.shown();
  EXPECT_GT(shown.size(), 7u);
  scene.show(nothing());
  EXPECT_EQ(viewer.follow(chunks), shown);
  EXPECT_TRUE(viewer.shown().empty());
  EXPECT_TRUE(viewer.follow(chunks).empty());
}

TEST_F(MeshChunksTest, onlyThoseThatChangedAreReported) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  Viewer viewer;
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

TEST_F(MeshChunksTest, oldestChangeComesFirst) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  Viewer viewer;
  scene.show(sphere({-0.08, -0.08, -0.08}, 0.03));
  chunks.follow();
  const size_t first = chunks.changedCount();
  const ChunkIndices near_first = [&] {
    MeshChunks others(compute(), map, {}, 2);
    return Viewer().follow(others);
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

TEST_F(MeshChunksTest, allAreReportedAgainToALateReader) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  scene.show(sphere({0.0, 0.0, 0.0}, 0.07));
  chunks.takeChanged(1000);
  chunks.noteAll();
  Viewer late;
  late.follow(chunks);
  late.expectTheWholeSurface(map);
}

TEST_F(MeshChunksTest, takenInTurnTheyAllComeAgain) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  scene.show(sphere({0.0, 0.0, 0.0}, 0.07));
  const size_t count = chunks.takeChanged(1000).size();
  Viewer unnoticed;
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

TEST_F(MeshChunksTest, resetForgetsThem) {
  BlockMap map(compute(), parameters(8));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  Viewer viewer;
  scene.show(sphere({0.0, 0.0, 0.0}, 0.07));
  viewer.follow(chunks, 3);
  map.reset({0.0, 0.0, 0.0});
  chunks.follow();
  EXPECT_EQ(chunks.changedCount(), 0u);
  EXPECT_TRUE(chunks.takeChanged(1000).empty());
  Viewer fresh;
  scene.show(sphere({0.03, 0.03, 0.03}, 0.04));
  fresh.follow(chunks);
  fresh.expectTheWholeSurface(map);
}

TEST_F(MeshChunksTest, whoHasMissedTooMuchShowsTheWholeSurfaceAllTheSame) {
  BlockMap map(compute(), parameters(4));
  ChangingMap scene(compute(), map);
  MeshChunks chunks(compute(), map, {}, 2);
  Viewer viewer;
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
  Mapper mapper(compute(), map, {}, kCamera);
  MeshChunks chunks(compute(), map, {}, 4);
  Viewer viewer;
  size_t released = 0;
  for (int frame = 0; frame < 14; ++frame) {
    RgbdFrame rgbd;
    rgbd.intrinsics = kCamera;
    rgbd.depth_unit_m = 1.0;
    rgbd.depth = frame < 5 ? bumpyDepth(1.2) : wallDepth(1.9);
    const View view = viewOf(rgbd.depth, somePose(0.1 * (frame % 3)));
    StageTimers timers;
    released += mapper.fuse(rgbd, frameOf(view), view.T_W_D, timers).fusion.blocks_released;
    viewer.follow(chunks);
    viewer.expectTheWholeSurface(map);
  }
  EXPECT_GT(released, 20u);
  EXPECT_FALSE(viewer.shown().empty());
}

}  // namespace
}  // namespace depth_fusion
