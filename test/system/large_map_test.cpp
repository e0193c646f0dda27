// Maps of 4096^3 and 5000^3 virtual voxels on a few frames of the room.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>

#include "compute/opencl.h"
#include "depth_fusion/common/error.h"
#include "support/synthetic_fusion.h"

namespace depth_fusion {
namespace {

struct FusedRoom {
  Reconstruction result;
  MeshError error;
};

PipelineParameters parametersOf(int blocks_per_axis, int block_size) {
  PipelineParameters parameters;
  parameters.map.blocks_per_axis = blocks_per_axis;
  parameters.map.block_size = block_size;
  return parameters;
}

FusedRoom fuseRoom(int blocks_per_axis, int block_size, Poses poses) {
  SimulationOptions options;
  options.frames = 4;
  options.fps = 15.0;
  ComputeContext compute;
  SimulatedRecording recording(options);
  FusedRoom room;
  room.result = reconstruct(compute, recording, parametersOf(blocks_per_axis, block_size), poses);
  room.error = compareMesh(room.result.mesh, room.result.T_W_M, recording.scene().surface);
  std::printf("N %d, M %d: %zu blocks, %zu MB, mesh %.3f m^2, mean error %.3f mm\n", blocks_per_axis,
              block_size, room.result.usage.blocks, room.result.usage.bytes / 1000000, room.error.area_m2,
              1000.0 * room.error.surface_m.mean);
  return room;
}

void expectPaperFormula(const FusedRoom& room, size_t n, size_t m) {
  const BlockMap::Usage& usage = room.result.usage;
  EXPECT_GT(usage.blocks, 0u);
  EXPECT_EQ(usage.bytes, 2 * usage.blocks * m * m * m + 4 * n * n * n);
  EXPECT_GE(usage.pool_bytes, usage.bytes);
}

// Rounding in ray casting depends on the window, so tracked poses, and with them the surfaces, agree but
// nearly.
void expectSameSurface(const MeshError& a, const MeshError& b) {
  EXPECT_NEAR(a.area_m2, b.area_m2, 0.02 * b.area_m2);
  EXPECT_NEAR(a.surface_m.mean, b.surface_m.mean, 0.0001);
  EXPECT_NEAR(a.surface_m.percentile95, b.surface_m.percentile95, 0.0003);
}

TEST(LargeMap, of_4096_voxels_an_axis_gives_the_same_surface_as_a_common_one) {
  const FusedRoom common = fuseRoom(256, 8, Poses::kTracked);
  EXPECT_GT(common.error.area_m2, 4.0);
  for (const auto& [n, m] : {std::make_pair(512, 8), std::make_pair(128, 32)}) {
    const FusedRoom room = fuseRoom(n, m, Poses::kTracked);
    expectPaperFormula(room, n, m);
    EXPECT_EQ(room.result.lost, 0u);
    expectSameSurface(room.error, common.error);
  }
}

TEST(LargeMap, size_of_the_window_changes_no_bit_at_given_poses) {
  const TriangleMesh common = fuseRoom(256, 8, Poses::kGiven).result.mesh;
  const TriangleMesh large = fuseRoom(512, 8, Poses::kGiven).result.mesh;
  ASSERT_EQ(large.vertices.size(), common.vertices.size());
  EXPECT_EQ(
      std::memcmp(large.vertices.data(), common.vertices.data(), large.vertices.size() * sizeof(MeshVertex)),
      0);
  EXPECT_TRUE(large.triangles == common.triangles);
}

TEST(LargeMap, of_5000_voxels_an_axis_is_fused) {
  constexpr size_t kOffsetBytes = size_t{4} * 625 * 625 * 625;
  {
    ComputeContext compute;
    const size_t limit = compute.impl().device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    if (limit < kOffsetBytes) GTEST_SKIP() << "the device's largest buffer has " << (limit >> 20) << " MiB";
  }
  const FusedRoom room = fuseRoom(625, 8, Poses::kTracked);
  expectPaperFormula(room, 625, 8);
  EXPECT_EQ(room.result.lost, 0u);
  EXPECT_GT(room.error.area_m2, 4.0);
  EXPECT_LT(room.error.surface_m.mean, 0.005);
}

}  // namespace
}  // namespace depth_fusion
