// Ways that are longer than window and pool: the map is, bit for bit, that of a window and a pool that hold
// all.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/submaps/world_mesh.h"
#include "support/test_compute.h"
#include "tools/evaluation/mesh_error.h"
#include "tools/evaluation/trajectory_error.h"
#include "tools/simulation/simulated_recording.h"

namespace depth_fusion {
namespace {

// Of a sensor of 320x240 that goes 0.6 m/s.
SimulationOptions walkThrough(const std::string& scene, int frames, double fps) {
  SimulationOptions options;
  options.scene = scene;
  options.frames = frames;
  options.fps = fps;
  options.noise = false;
  options.intrinsics = halved(makeScene(scene).sensor.camera);
  return options;
}

PipelineParameters ofWindow(int blocks_per_axis, int pool_mib, bool color) {
  PipelineParameters parameters;
  parameters.map.voxel_size_m = 0.02f;
  parameters.map.blocks_per_axis = blocks_per_axis;
  parameters.map.pool_mib = pool_mib;
  parameters.map.color = color;
  parameters.preprocessing.max_range_m = 3.0f;
  parameters.submaps.memory_mib = 1;
  return parameters;
}

struct Outcome {
  Trajectory estimate, truth;
  size_t lost = 0, left_out = 0, submaps = 0, blocks = 0, most_in_pool = 0;
  StoreUsage store;
  TriangleMesh mesh;
};

Outcome walk(const SimulationOptions& options, const PipelineParameters& parameters, bool is_given) {
  SimulatedRecording recording(options);
  std::unique_ptr<ReconstructionPipeline> pipeline;
  Outcome outcome;
  while (const std::optional<RgbdFrame> frame = recording.next()) {
    if (!pipeline)
      pipeline = std::make_unique<ReconstructionPipeline>(compute(), parameters, frame->intrinsics);
    const FrameResult result =
        is_given ? pipeline->processFrame(*frame, *frame->T_W_D) : pipeline->processFrame(*frame);
    outcome.left_out +=
        result.fusion.points_outside + result.fusion.blocks_requested - result.fusion.blocks_allocated;
    outcome.most_in_pool = std::max(outcome.most_in_pool, pipeline->map().usage().blocks);
    if (result.tracking.status == TrackingStatus::kLost) {
      ++outcome.lost;
      continue;
    }
    outcome.estimate.push_back({frame->stamp_s, result.tracking.T_W_D});
    outcome.truth.push_back({frame->stamp_s, *frame->T_W_D});
  }
  outcome.submaps = pipeline->submaps().submaps().size();
  outcome.blocks = pipeline->submaps().blockCount();
  outcome.store = pipeline->submaps().usage();
  WorldSnapshot world(pipeline->submaps());
  exportWorldMesh(compute(), world, outcome.mesh, parameters.surface_mesh, world.hasColor());
  std::printf(
      "%zu lost, %zu left out, %zu submaps, %zu blocks, %zu in the pool at most, %zu put, %zu taken\n",
      outcome.lost, outcome.left_out, outcome.submaps, outcome.blocks, outcome.most_in_pool,
      static_cast<size_t>(outcome.store.blocks_put), static_cast<size_t>(outcome.store.blocks_taken));
  return outcome;
}

// A triangle's corners by position and colour.
using Corners = std::array<float, 18>;

// A mesh's triangles in an order of no other meaning.
std::vector<Corners> sortedTriangles(const TriangleMesh& mesh) {
  std::vector<Corners> triangles;
  for (const MeshTriangle& triangle : mesh.triangles) {
    Corners corners{};
    const auto first =
        static_cast<size_t>(std::min_element(triangle.begin(), triangle.end(),
                                             [&](uint32_t a, uint32_t b) {
                                               const auto key = [&](uint32_t v) {
                                                 const Eigen::Vector3f& p = mesh.vertices[v].position_W;
                                                 return std::array<float, 3>{p.x(), p.y(), p.z()};
                                               };
                                               return key(a) < key(b);
                                             }) -
                            triangle.begin());
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t vertex = triangle[(first + i) % 3];
      for (int axis = 0; axis < 3; ++axis) {
        corners[6 * i + axis] = mesh.vertices[vertex].position_W[axis];
        if (!mesh.colors.empty()) corners[6 * i + 3 + axis] = mesh.colors[vertex][axis];
      }
    }
    triangles.push_back(corners);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

class LongWalk : public testing::TestWithParam<bool> {};

TEST_P(LongWalk, GivesTheMeshOfAMapThatHoldsAll) {
  const SimulationOptions options = walkThrough("corridor", 75, 3.0);  // 15 m
  const Outcome all = walk(options, ofWindow(160, 64, GetParam()), true);
  const Outcome paged = walk(options, ofWindow(48, 4, GetParam()), true);
  EXPECT_EQ(all.store.blocks_put, 0u);
  EXPECT_EQ(all.submaps, 1u);
  EXPECT_GT(paged.store.blocks_put, 1000u);
  EXPECT_GT(paged.submaps, 2u);
  EXPECT_LT(2 * paged.most_in_pool, paged.blocks);
  EXPECT_EQ(all.left_out + paged.left_out, 0u);
  EXPECT_EQ(paged.blocks, all.blocks);
  EXPECT_EQ(paged.mesh.vertices.size(), all.mesh.vertices.size()) << "no vertex twice where parts meet";
  EXPECT_TRUE(sortedTriangles(paged.mesh) == sortedTriangles(all.mesh));
}

// The triangles that a viewer has who got these chunks.
class ChunkViewer {
 public:
  explicit ChunkViewer(ReconstructionPipeline& pipeline) : chunks_(compute(), pipeline.map()) {
    chunks_.lookElsewhere(std::make_unique<WorldParts>(compute(), pipeline.submaps()));
  }
  void update() {
    for (const MeshChunk& chunk : chunks_.takeChanged(100000))
      meshes_[chunk.index] = sortedTriangles(chunk.mesh);
  }
  std::vector<Corners> triangles() const {
    std::vector<Corners> all;
    for (const auto& [index, mesh] : meshes_) all.insert(all.end(), mesh.begin(), mesh.end());
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  MeshChunks chunks_;
  std::map<MeshChunkIndex, std::vector<Corners>> meshes_;
};

// Whoever follows the surface sees all of it: from the start on, or who comes in the end.
TEST(LiveView, HasTheWholeSurface) {
  SimulatedRecording recording(walkThrough("corridor", 60, 3.0));
  const PipelineParameters parameters = ofWindow(48, 4, false);
  std::unique_ptr<ReconstructionPipeline> pipeline;
  std::unique_ptr<ChunkViewer> early;
  for (int i = 0; const std::optional<RgbdFrame> frame = recording.next(); ++i) {
    if (!pipeline) {
      pipeline = std::make_unique<ReconstructionPipeline>(compute(), parameters, frame->intrinsics);
      early = std::make_unique<ChunkViewer>(*pipeline);
    }
    pipeline->processFrame(*frame, *frame->T_W_D);
    if (i % 4 == 0) early->update();
  }
  ASSERT_GT(pipeline->submaps().usage().blocks_put, 1000u);
  early->update();
  ChunkViewer late(*pipeline);
  late.update();
  WorldSnapshot world(pipeline->submaps());
  TriangleMesh mesh;
  exportWorldMesh(compute(), world, mesh, parameters.surface_mesh, false);
  EXPECT_TRUE(early->triangles() == sortedTriangles(mesh));
  EXPECT_TRUE(late.triangles() == sortedTriangles(mesh));
}

INSTANTIATE_TEST_SUITE_P(WithoutAndWithColour, LongWalk, testing::Bool());

// What is tracked against a map that comes and goes is tracked as well as against one that stays.
TEST(TrackedWalk, IsAsAccurateWithAPoolThatIsTooSmall) {
  const SimulationOptions options = walkThrough("room", 150, 15.0);
  PipelineParameters parameters = ofWindow(128, 64, false);
  parameters.map.voxel_size_m = 0.01f;
  const Outcome all = walk(options, parameters, false);
  parameters.map.pool_mib = 4;
  parameters.submaps.max_length_m = 1.0f;
  const Outcome paged = walk(options, parameters, false);
  EXPECT_EQ(all.lost + paged.lost, 0u);
  EXPECT_GT(paged.submaps, 1u);
  EXPECT_GT(paged.store.blocks_taken, 0u);
  const auto error_m = [](const Outcome& outcome) {
    return compareTrajectories(outcome.estimate, outcome.truth).ate_m.rmse;
  };
  std::printf("%.3f and %.3f mm\n", 1000.0 * error_m(all), 1000.0 * error_m(paged));
  EXPECT_LE(error_m(paged), 1.03 * error_m(all) + 1e-4);
}

}  // namespace
}  // namespace depth_fusion
