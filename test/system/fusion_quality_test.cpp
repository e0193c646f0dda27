// How good fusion is at given poses: accuracy, what moves, what is thin.
#include <gtest/gtest.h>

#include <cstdio>

#include "support/changing_scene.h"

namespace depth_fusion {
namespace {

PipelineParameters byRule(const std::string& rule) {
  PipelineParameters parameters = fineVoxels();
  parameters.tsdf_fusion.rule = rule;
  return parameters;
}

ErrorStatistics surfaceError(const std::string& rule) {
  const Solids solids = tableWithThings();
  SceneFusion fusion({[&](int) { return solids; }}, byRule(rule));
  fusion.fuseUntil(100);
  const MeshError error = compareMesh(fusion.mesh(), Pose::Identity(), Scene(solids));
  std::printf("%s: %.2f m^2, mean %.3f mm, 95 %% %.3f mm\n", rule.c_str(), error.area_m2,
              1000.0 * error.surface_m.mean, 1000.0 * error.surface_m.percentile95);
  EXPECT_GT(error.area_m2, 2.0);
  return error.surface_m;
}

TEST(FusionQuality, kalman_is_accurate_and_weighted_is_near_it) {
  const ErrorStatistics kalman = surfaceError("kalman");
  EXPECT_LE(kalman.mean, 0.0007);
  EXPECT_LE(kalman.percentile95, 0.002);
  EXPECT_LE(surfaceError("weighted").mean, 1.15 * kalman.mean);
}

constexpr size_t kLargestGhost = 20;  // vertices

struct Ghosts {
  size_t largest = 0, vertices = 0;
};

Ghosts ghostsOf(SceneFusion& fusion) {
  Ghosts ghosts;
  for (const size_t size : fusion.ghosts(corner(), 0.02)) {
    ghosts.largest = std::max(ghosts.largest, size);
    ghosts.vertices += size;
  }
  std::printf("%zu vertices of ghosts, the largest of %zu\n", ghosts.vertices, ghosts.largest);
  return ghosts;
}

// Not the running average: at the gain that smooths it answers too slowly, as the paper says.
class ByRule : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(FusionQuality, ByRule, testing::Values("kalman", "weighted"));

TEST_P(ByRule, removed_object_is_gone_within_30_frames) {
  Solids with = corner();
  with.push_back(box({0.0, 1.3, 0.3}, {0.5, 0.4, 0.6}, {}, 0.3));
  const auto solids_at = [&](int frame) { return frame < 60 ? with : corner(); };
  SceneFusion fusion({solids_at}, byRule(GetParam()), halved(kFullSize));
  fusion.fuseUntil(60);
  EXPECT_GT(ghostsOf(fusion).vertices, 5000u) << "the object is not there at first";
  fusion.fuseUntil(90);
  EXPECT_LE(ghostsOf(fusion).largest, kLargestGhost);
}

TEST_P(ByRule, walker_leaves_no_ghost) {
  const auto solids_at = [](int frame) {
    Solids solids = corner();
    const double x = -1.6 + frame / 30.0;  // at 1 m/s
    solids.push_back(box({x, 1.4, 0.85}, {0.45, 0.3, 1.7}, {}, 0.2));
    return solids;
  };
  SceneFusion fusion({solids_at}, byRule(GetParam()), halved(kFullSize));
  fusion.fuseUntil(48);
  EXPECT_GT(ghostsOf(fusion).largest, 500u) << "the walker is not seen";
  fusion.fuseUntil(110);
  EXPECT_LE(ghostsOf(fusion).largest, kLargestGhost);
}

// Vertices within 3 mm of a rod of 1 cm that stands at 1 m, before a wall and a floor, in its slices of 5 mm.
std::vector<int> rodSlices(const PipelineParameters& parameters) {
  const Primitive rod = cylinder({0.0, 1.0, 0.4}, {0.0, 1.0, 1.4}, 0.005, {});
  Solids solids = corner();
  solids.push_back(rod);
  SceneFusion fusion({[&](int) { return solids; }}, parameters);
  fusion.fuseUntil(60);
  std::vector<int> slices(120, 0);
  for (const MeshVertex& vertex : fusion.mesh().vertices) {
    const Eigen::Vector3d p = vertex.position_W.cast<double>();
    const int slice = static_cast<int>(std::floor((p.z() - 0.6) / 0.005));
    if (slice >= 0 && slice < 120 && std::abs(rod.distance(p)) < 0.003) ++slices[slice];
  }
  return slices;
}

TEST_P(ByRule, rod_of_1_cm_at_1_m_is_not_eaten) {
  PipelineParameters uncarved = byRule(GetParam());
  uncarved.tsdf_fusion.free_space_rate = 0.0f;
  const std::vector<int> expected = rodSlices(uncarved);
  const std::vector<int> slices = rodSlices(byRule(GetParam()));
  EXPECT_EQ(std::count(slices.begin(), slices.end(), 0), 0) << "the rod is cut";
  const int all = std::accumulate(slices.begin(), slices.end(), 0);
  const int uneaten = std::accumulate(expected.begin(), expected.end(), 0);
  std::printf("rod: %d vertices, %d without carving\n", all, uneaten);
  EXPECT_GE(all, 0.8 * uneaten);
}

}  // namespace
}  // namespace depth_fusion
