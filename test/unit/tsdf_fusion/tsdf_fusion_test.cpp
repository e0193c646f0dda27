#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"

#include <gtest/gtest.h>

#include <set>

#include "support/expect_error.h"
#include "support/fusion_views.h"
#include "tsdf_fusion/filter_options.h"
#include "tsdf_fusion/tsdf_fusion_kernels.h"

namespace depth_fusion {
namespace {

// How a byte may differ from the reference's number before it was rounded to the one below or above.
struct RoundingErrors {
  size_t voxels = 0, updated = 0, noisy = 0, freed = 0, skipped = 0, wrong = 0;
  double sum_steps = 0.0, sum_certainties = 0.0;

  void addHit(const Voxel& expected, const Voxel& fused) {
    ++updated;
    const double error = fused.steps - expected.steps;
    const double certainty_error = fused.certainty - expected.certainty;
    if (!fused.known || std::abs(error) > 1.02 || std::abs(certainty_error) > 1.02) ++wrong;
    sum_certainties += certainty_error;
    sum_steps += error;
  }

  void addFree(const Voxel& expected, const Voxel& fused, int min_certainty) {
    ++freed;
    const bool stays = fused.known && fused.steps == expected.steps && fused.certainty >= min_certainty &&
                       std::abs(fused.certainty - expected.certainty) < 1.001;
    const bool goes = !fused.known && expected.certainty < min_certainty + 0.001;
    if (!stays && !goes) ++wrong;
  }
};

RoundingErrors compareWithReference(const MapContent& before, const MapContent& after, const View& view,
                                    const MapParameters& map, const TsdfFusionParameters& fusion) {
  RoundingErrors errors;
  const Pose T_D_W = view.T_W_D.inverse();
  const int min_certainty = fusionArgs(fusion, map, frameOf(view), 0).min_certainty;
  for (const auto& [key, content] : after) {
    const auto old = before.find(key);
    for (size_t i = 0; i < content.distances.size(); ++i) {
      const BlockIndex block = indexOf(key);
      const Measurement measured =
          measure(view, T_D_W, map, fusion, block, voxelOf(block, static_cast<int>(i), map.block_size));
      const Voxel old_voxel = old == before.end() ? Voxel() : voxelOf(old->second, i);
      const Voxel fused = voxelOf(content, i);
      ++errors.voxels;
      if (measured.ambiguous) {
        ++errors.skipped;
      } else if (measured.kind == Measurement::kHit ||
                 (measured.kind == Measurement::kNoisyHit && old_voxel.known)) {
        errors.noisy += measured.kind == Measurement::kNoisyHit;
        errors.addHit(fuse(old_voxel, measured, fusion), fused);
      } else if (measured.kind == Measurement::kFree && old_voxel.known) {
        errors.addFree(fuse(old_voxel, measured, fusion), fused, min_certainty);
      } else if (fused.known != old_voxel.known || (fused.known && fused.steps != old_voxel.steps)) {
        ++errors.wrong;
      }
    }
  }
  return errors;
}

TsdfFusionParameters fusionBy(const std::string& rule, const std::string& distance) {
  TsdfFusionParameters parameters;
  parameters.rule = rule;
  parameters.distance = distance;
  return parameters;
}

void expectTheReference(const MapParameters& map_parameters, const TsdfFusionParameters& fusion_parameters) {
  BlockMap map(compute(), map_parameters);
  TsdfFusion fusion(compute(), map, fusion_parameters);
  MapContent before;
  size_t freed = 0;
  for (int frame = 0; frame < 4; ++frame) {
    const View view = viewOf(bumpyDepth(1.1 + 0.08 * frame), somePose(1.0 - 0.1 * frame));
    integrate(fusion, view);
    const MapContent after = readMap(map);
    const RoundingErrors errors =
        compareWithReference(before, after, view, map_parameters, fusion_parameters);
    const double updated = static_cast<double>(errors.updated);
    EXPECT_GT(errors.updated, 4000u);
    EXPECT_LE(errors.wrong, errors.updated / 100000) << "of " << errors.updated << " and " << errors.freed;
    EXPECT_LT(errors.skipped, errors.voxels / 50);
    EXPECT_NEAR(errors.sum_steps / updated, 0.0, 0.02) << "rounding is biased";
    EXPECT_NEAR(errors.sum_certainties / updated, 0.0, 0.02) << "rounding of certainties is biased";
    freed += errors.freed;
    before = after;
  }
  EXPECT_GT(freed, 100u);
}

class FusionOfBlockSize : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(BlockSizes, FusionOfBlockSize, testing::Values(4, 8, 16, 32));

TEST_P(FusionOfBlockSize, EqualsTheReferenceFrameByFrame) {
  expectTheReference(mapParameters(GetParam(), 18, 0.16f / GetParam()), {});
}

using RuleAndDistance = std::tuple<std::string, std::string>;

class FusionByRule : public testing::TestWithParam<RuleAndDistance> {};

INSTANTIATE_TEST_SUITE_P(Rules, FusionByRule,
                         testing::Combine(testing::Values("average", "weighted", "kalman"),
                                          testing::Values("projective", "plane", "refined")));

TEST_P(FusionByRule, EqualsTheReferenceFrameByFrame) {
  expectTheReference(mapParameters(8, 18, 0.02f), fusionBy(std::get<0>(GetParam()), std::get<1>(GetParam())));
}

TEST(TsdfFusion, RefusesWhatIsNoRule) {
  BlockMap map(compute(), mapParameters());
  expectError([&] { TsdfFusion(compute(), map, fusionBy("mean", "plane")); }, {"'rule'", "'mean'", "kalman"});
  expectError([&] { TsdfFusion(compute(), map, fusionBy("kalman", "exact")); }, {"'distance'", "refined"});
  TsdfFusionParameters parameters;
  parameters.process_sigma_m = std::nanf("");
  expectError([&] { TsdfFusion(compute(), map, parameters); }, {"process_sigma_m"});
}

TEST(TsdfFusion, NumbersMayChangeAndTheRuleNot) {
  BlockMap map(compute(), mapParameters());
  TsdfFusion fusion(compute(), map, fusionBy("kalman", "plane"));
  TsdfFusionParameters parameters = fusionBy("kalman", "plane");
  parameters.process_sigma_m = 0.001f;
  fusion.setParameters(parameters);
  expectError([&] { fusion.setParameters(fusionBy("average", "plane")); }, {"tsdf_fusion/rule"});
  expectError([&] { fusion.setParameters(fusionBy("kalman", "refined")); }, {"tsdf_fusion/distance"});
}

struct Deviation {
  double mean = 0.0, spread = 0.0;
};

Deviation deviationOf(const std::vector<double>& values) {
  cv::Scalar mean, spread;
  cv::meanStdDev(values, mean, spread);
  return {mean[0], spread[0]};
}

void expectDataInEveryBlock(BlockMap& map) {
  for (const auto& [key, content] : readMap(map)) {
    const auto& distances = content.distances;
    ASSERT_TRUE(std::any_of(distances.begin(), distances.end(), [](int8_t d) { return d != TSDF_CHI; }))
        << indexOf(key).transpose();
  }
}

constexpr double kFarWall_m = 4.5;  // where sigma is 1.6 times the truncation

MapParameters farWallParameters() {
  MapParameters parameters = mapParameters(8, 64, 0.01f);
  parameters.truncation_m = 0.02f;
  return parameters;
}

View noisyWall(cv::RNG& random) {
  cv::Mat depth = wallDepth(kFarWall_m), noise(depth.size(), CV_32FC1);
  random.fill(noise, cv::RNG::NORMAL, 0.0, reference::sensorSigma(kFarWall_m));
  View view = viewOf(wallDepth(kFarWall_m));
  view.depth = depth + noise;
  view.measurements = quantised(reference::measurements(view.depth, view.normals, cv::Mat(), view.camera));
  return view;
}

TEST(TsdfFusion, EqualsTheReferenceWhereNoiseIsLargerThanTheTruncation) {
  const MapParameters parameters = farWallParameters();
  BlockMap map(compute(), parameters);
  TsdfFusion fusion(compute(), map, {});
  map.placeWindow(Eigen::Vector3d(0.0, 0.0, kFarWall_m));
  cv::RNG random(1);
  MapContent before;
  size_t noisy = 0;
  for (int frame = 0; frame < 3; ++frame) {
    const View view = noisyWall(random);
    integrate(fusion, view);
    const MapContent after = readMap(map);
    const RoundingErrors errors = compareWithReference(before, after, view, parameters, {});
    EXPECT_LE(errors.wrong, errors.updated / 100000) << "of " << errors.updated;
    noisy += errors.noisy;
    before = after;
  }
  EXPECT_GT(noisy, 1000u);
}

// Where measurements beyond the truncation do not count, voxels in front of a wall and behind it look alike
// after many frames.
TEST(TsdfFusion, ToldFromBehindAWallWhoseNoiseIsLargerThanTheTruncation) {
  BlockMap map(compute(), farWallParameters());
  TsdfFusion fusion(compute(), map, {});
  map.placeWindow(Eigen::Vector3d(0.0, 0.0, kFarWall_m));
  cv::RNG random(1);
  for (int frame = 0; frame < 40; ++frame) integrate(fusion, noisyWall(random));
  size_t voxels = 0, wrong = 0;
  for (const auto& [key, content] : readMap(map)) {
    for (size_t i = 0; i < content.distances.size(); ++i) {
      const double in_front_m =
          kFarWall_m - voxelOf(indexOf(key), static_cast<int>(i), 8).cast<double>().z() * 0.01;
      if (content.distances[i] == TSDF_CHI || std::abs(in_front_m) < 0.015 || std::abs(in_front_m) > 0.03)
        continue;
      ++voxels;
      wrong += (content.distances[i] > 0) != (in_front_m > 0.0);
    }
  }
  std::printf("%zu of %zu voxels on the wrong side\n", wrong, voxels);
  EXPECT_GT(voxels, 10000u);
  EXPECT_LT(wrong, voxels / 20);
}

class FreeSpaceByRule : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Rules, FreeSpaceByRule, testing::Values("average", "weighted", "kalman"));

TEST_P(FreeSpaceByRule, ClearsWhatStoodThere) {
  BlockMap map(compute(), mapParameters());
  TsdfFusion fusion(compute(), map, fusionBy(GetParam(), "plane"));
  for (int i = 0; i < 100; ++i) integrate(fusion, viewOf(wallDepth(1.0)));
  const size_t before = map.usage().blocks;
  ASSERT_GT(before, 40u);
  size_t released = 0;
  for (int i = 0; i < 30; ++i) released += integrate(fusion, viewOf(wallDepth(2.0))).blocks_released;
  EXPECT_GE(released, before / 2);
  for (const auto& [key, content] : readMap(map)) {
    for (size_t i = 0; i < content.distances.size(); ++i) {
      const Eigen::Vector3d p = voxelOf(indexOf(key), static_cast<int>(i), 8).cast<double>() * 0.02;
      const bool well_inside = std::abs(p.x()) < 0.4 * p.z() && std::abs(p.y()) < 0.3 * p.z();
      if (well_inside && p.z() < 1.9) {
        ASSERT_EQ(content.distances[i], TSDF_CHI) << p.transpose();
      }
    }
  }
}

TEST(TsdfFusion, CountsTheSurfaceOutsideOfTheWindow) {
  BlockMap map(compute(), mapParameters(8, 4));
  TsdfFusion fusion(compute(), map, {});
  EXPECT_GT(integrate(fusion, viewOf(wallDepth(3.0))).points_outside, 100u);
  map.reset(Eigen::Vector3d(0.0, 0.0, 0.3));
  EXPECT_EQ(integrate(fusion, viewOf(wallDepth(0.3))).points_outside, 0u);
}

TEST(TsdfFusion, BlocksWithoutDataAreReleased) {
  BlockMap map(compute(), mapParameters(4));
  TsdfFusion fusion(compute(), map, {});
  const FusionResult result = integrate(fusion, viewOf(bumpyDepth(1.5), somePose()));
  EXPECT_EQ(result.blocks_allocated, result.blocks_requested);
  EXPECT_EQ(map.usage().blocks, result.blocks_allocated - result.blocks_released);
  expectDataInEveryBlock(map);
  std::vector<int> offsets = map.offsets().read<int>(map.offsets().bytes() / sizeof(int));
  EXPECT_EQ(map.usage().blocks, offsets.size() - std::count(offsets.begin(), offsets.end(), BLOCK_EMPTY));
}

TEST(TsdfFusion, NoDepthChangesNothing) {
  BlockMap map(compute(), mapParameters());
  TsdfFusion fusion(compute(), map, {});
  integrate(fusion, viewOf(bumpyDepth(1.5)));
  const MapContent before = readMap(map);
  const FusionResult result = integrate(fusion, viewOf(wallDepth(0.0)));
  EXPECT_EQ(result.blocks_requested + result.blocks_updated + result.blocks_released, 0u);
  EXPECT_TRUE(readMap(map) == before);
}

TEST(TsdfFusion, FullPoolFusesWhatFitsAndAsksAgain) {
  MapParameters parameters = mapParameters(8, 96, 0.007f);
  parameters.pool_mib = 1;
  BlockMap map(compute(), parameters);
  TsdfFusion fusion(compute(), map, {});
  const View view = viewOf(wallDepth(2.2));
  const FusionResult first = integrate(fusion, view);
  EXPECT_EQ(first.blocks_allocated, 1024u);
  EXPECT_GT(first.blocks_requested, first.blocks_allocated);
  EXPECT_EQ(first.blocks_updated, 1024u);
  const FusionResult second = integrate(fusion, view);
  EXPECT_EQ(second.blocks_requested, first.blocks_requested - first.blocks_allocated + first.blocks_released);
  EXPECT_EQ(second.blocks_allocated, first.blocks_released);
  expectDataInEveryBlock(map);
}

// More blocks than one list of requests holds.
TEST(TsdfFusion, AllocatesAllTheBlocksOfAFineMap) {
  const CameraIntrinsics camera{320, 240, 262.5, 262.5, 159.5, 119.5};
  MapParameters parameters = mapParameters(4, 220, 0.005f);
  parameters.truncation_m = 0.06f;
  BlockMap map(compute(), parameters);
  map.reset(Eigen::Vector3d(0.0, 0.0, 3.0));
  TsdfFusion fusion(compute(), map, {});
  const cv::Mat depth(camera.height, camera.width, CV_32FC1, cv::Scalar(3.0));
  const View wall = viewOf(depth, Pose::Identity(), camera);
  const FusionResult first = integrate(fusion, wall);
  EXPECT_GT(first.blocks_requested, 100000u);
  EXPECT_EQ(first.blocks_allocated, first.blocks_requested);
  EXPECT_EQ(integrate(fusion, wall).blocks_requested, first.blocks_released);
}

TEST(TsdfFusion, WindowMayStandAnywhere) {
  MapContent expected;
  for (const Eigen::Vector3d& centre :
       {Eigen::Vector3d(0, 0, 1), {0.9, 0.5, 1.3}, {-0.7, -0.83, 0.2}, {0.33, -0.61, 1.77}}) {
    MapParameters parameters = mapParameters(8, 31);
    BlockMap map(compute(), parameters);
    map.reset(centre);
    TsdfFusion fusion(compute(), map, {});
    for (int i = 0; i < 3; ++i) integrate(fusion, viewOf(bumpyDepth(1.2), somePose(0.5 + 0.1 * i)));
    const MapContent content = readMap(map);
    if (expected.empty()) expected = content;
    ASSERT_GT(content.size(), 100u);
    EXPECT_TRUE(content == expected) << centre.transpose();
  }
}

TEST(TsdfFusion, ZeroCrossingIsTheSurface) {
  const MapParameters parameters = mapParameters(8, 64, 0.01f);
  BlockMap map(compute(), parameters);
  TsdfFusion fusion(compute(), map, {});
  for (int i = 0; i < 50; ++i) integrate(fusion, viewOf(wallDepth(1.0433)));
  std::vector<double> errors;
  for (const auto& [key, content] : readMap(map)) {
    for (int i = 0; i < 7 * 64; ++i) {  // all but the last layer of each block
      const int near = content.distances[i], far = content.distances[i + 64];
      if (near == TSDF_CHI || far == TSDF_CHI || near < 0 || far >= 0) continue;
      const double z_vox = voxelOf(indexOf(key), i, 8).z() + static_cast<double>(near) / (near - far);
      errors.push_back(z_vox * parameters.voxel_size_m - 1.0433);
    }
  }
  ASSERT_GT(errors.size(), 1000u);
  EXPECT_NEAR(deviationOf(errors).mean, 0.0, 2e-5);
  EXPECT_LT(deviationOf(errors).spread, 5e-4);
}

// Every name has kernels of its own, and what has no name is not built as something else.
TEST(TsdfFusion, RulesAndDistancesAreBuiltByTheirNames) {
  std::set<std::string> options;
  TsdfFusionParameters parameters;
  for (const std::string& rule : fusionRules()) {
    for (const std::string& distance : filterDistances().names()) {
      parameters.rule = rule;
      parameters.distance = distance;
      EXPECT_TRUE(options.insert(filterOptions(parameters)).second);
    }
  }
  EXPECT_EQ(options.size(), 9u);
  parameters.rule = "kallman";
  EXPECT_THROW(filterOptions(parameters), Error);
  BlockMap map(compute(), mapParameters());
  EXPECT_THROW(TsdfFusion::Kernels(compute(), map, parameters), Error);
}

}  // namespace
}  // namespace depth_fusion
