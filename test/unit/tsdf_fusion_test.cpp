#include "depth_fusion/tsdf_fusion/tsdf_fusion.h"

#include <gtest/gtest.h>

#include <random>

#include "reference/tsdf_fusion.h"
#include "support/device_frames.h"
#include "support/test_compute.h"
#include "support/test_frames.h"
#include "tsdf_fusion/tsdf_fusion_kernels.h"

namespace depth_fusion {
namespace {

using BlockIndex = BlockSparseMap::BlockIndex;
using reference::Measurement;
using reference::View;
using reference::Voxel;

constexpr CameraIntrinsics kCamera{101, 74, 90.0, 92.0, 49.3, 37.1};

MapParameters mapParameters(int block_size = 8, int blocks_per_axis = 32, float voxel_size_m = 0.02f) {
  MapParameters parameters;
  parameters.voxel_size_m = voxel_size_m;
  parameters.truncation_m = 3.0f * voxel_size_m;
  parameters.block_size = block_size;
  parameters.blocks_per_axis = blocks_per_axis;
  parameters.pool_mib = 64;
  return parameters;
}

cv::Mat wallDepth(double z_m) { return cv::Mat(kCamera.height, kCamera.width, CV_32FC1, cv::Scalar(z_m)); }

// A bumpy wall with a hole and a box in front of it.
cv::Mat bumpyDepth(double z_m) {
  cv::Mat depth = wallDepth(z_m);
  reference::forEachPixel<float>(depth, [&](int x, int y, float& pixel) {
    pixel += static_cast<float>(0.1 * std::sin(0.13 * x) + 0.002 * y);
    if (x > 20 && x < 40 && y > 20 && y < 50) pixel -= 0.4f;
    if (x > 60 && x < 70) pixel = 0.0f;
  });
  return depth;
}

Pose somePose(double scale = 1.0) {
  Vector6d twist;
  twist << 0.2, -0.3, 0.15, 0.11, 0.07, -0.23;
  return poseFromTwist(scale * twist);
}

View viewOf(const cv::Mat& depth, const Pose& T_W_D = Pose::Identity()) { return {kCamera, T_W_D, depth}; }

FusionArgs fusionArgs(const FusionParameters& parameters = {}) {
  return {parameters.weight_at_1m, 0.25f, 16.0f, parameters.max_weight, 0};
}

FusionResult integrate(TsdfFusion& fusion, const View& view) {
  StageTimers timers;
  return fusion.integrate(frameOfDepth(compute(), view.camera, view.depth), view.T_W_D, timers);
}

std::vector<BlockIndex> windowBlocks(const BlockSparseMap& map) {
  const int n = map.parameters().blocks_per_axis;
  std::vector<BlockIndex> blocks;
  for (int i = 0; i < n * n * n; ++i)
    blocks.push_back(map.origin() + BlockIndex(i % n, i / n % n, i / n / n));
  return blocks;
}

bool inWindow(const BlockSparseMap& map, const BlockKey& key) {
  const Eigen::Array3i local = (indexOf(key) - map.origin()).array();
  return (local >= 0).all() && (local < map.parameters().blocks_per_axis).all();
}

Eigen::Vector3i voxelOf(const BlockIndex& block, int number, int m) {
  return m * block + Eigen::Vector3i(number % m, number / m % m, number / m / m);
}

Voxel voxelOf(const BlockContent& content, size_t number) {
  Voxel voxel;
  voxel.known = content.distances[number] != TSDF_CHI;
  voxel.steps = content.distances[number];
  voxel.weight = content.weights[number];
  return voxel;
}

class BlockRequests {
 public:
  explicit BlockRequests(BlockSparseMap& map)
      : map_(map),
        kernels_(compute(), map.parameters()),
        list_(compute(), kCapacity * 4 * sizeof(int), "requests"),
        count_(compute(), sizeof(int), "count") {}

  // The blocks that the kernel lists; count is what it counted.
  std::vector<BlockIndex> of(const View& view, SelectionArgs args, int& count) {
    count_.fill(0, sizeof(int));
    const DepthFrame frame = frameOfDepth(compute(), view.camera, view.depth);
    kernels_.requestBlocks(frame, map_, list_, count_, view.T_W_D, args);
    count = count_.read<int>(1).front();
    const int listed = std::min(count, args.capacity);
    const std::vector<int> entries = list_.read<int>(4 * listed);
    std::vector<BlockIndex> blocks;
    for (int i = 0; i < listed; ++i)
      blocks.emplace_back(entries[4 * i], entries[4 * i + 1], entries[4 * i + 2]);
    return blocks;
  }

  static constexpr int kCapacity = 20000;

 private:
  BlockSparseMap& map_;
  TsdfFusion::Kernels kernels_;
  DeviceBuffer list_, count_;
};

std::set<BlockKey> keysOf(const std::vector<BlockIndex>& blocks) {
  std::set<BlockKey> keys;
  for (const BlockIndex& block : blocks) keys.insert(keyOf(block));
  return keys;
}

// Every block of the reference in the window, but for those that rounding decides, and no other.
void expectRequests(const BlockSparseMap& map, const View& view, const SelectionArgs& args,
                    const std::set<BlockKey>& requested) {
  const std::set<BlockKey> possible = blocksInBands(view, map.parameters(), args, 1e-5);
  for (const BlockKey& key : requested) {
    ASSERT_TRUE(possible.count(key) && inWindow(map, key)) << indexOf(key).transpose();
  }
  size_t certain = 0;
  for (const BlockKey& key : blocksInBands(view, map.parameters(), args, -1e-5)) {
    if (!inWindow(map, key)) continue;
    ++certain;
    ASSERT_TRUE(requested.count(key)) << indexOf(key).transpose();
  }
  EXPECT_GT(certain, 20u);
  EXPECT_LE(requested.size() - certain, 3u);
}

class FusionOfBlockSize : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(BlockSizes, FusionOfBlockSize, testing::Values(4, 8, 16, 32));

TEST_P(FusionOfBlockSize, RequestsTheBlocksInTheTruncationBands) {
  const MapParameters parameters = mapParameters(GetParam(), 37, 0.16f / GetParam());
  for (const Eigen::Vector3d& centre : {Eigen::Vector3d(0, 0, 0), {2.1, -1.3, 3.9}, {-2.9, 0.2, 0.7}}) {
    for (const int stride : {1, 3}) {
      BlockSparseMap map(compute(), parameters);
      map.reset(centre);  // part of the surface lies outside of the window
      const SelectionArgs args{stride, 4, BlockRequests::kCapacity};
      const View view = viewOf(bumpyDepth(2.0), somePose());
      int count = 0;
      const std::vector<BlockIndex> blocks = BlockRequests(map).of(view, args, count);
      const std::set<BlockKey> requested = keysOf(blocks);
      ASSERT_EQ(requested.size(), blocks.size()) << "a block was requested twice";
      ASSERT_EQ(static_cast<int>(blocks.size()), count);
      expectRequests(map, view, args, requested);
    }
  }
}

TEST(BlockSelection, RequestsOnlyWhatIsNotAllocated) {
  BlockSparseMap map(compute(), mapParameters());
  BlockRequests requests(map);
  const View view = viewOf(bumpyDepth(1.5), somePose());
  const SelectionArgs args{1, 4, BlockRequests::kCapacity};
  int count = 0;
  const std::vector<BlockIndex> blocks = requests.of(view, args, count);
  EXPECT_EQ(map.allocate(blocks), blocks.size());
  EXPECT_TRUE(requests.of(view, args, count).empty());
}

TEST(BlockSelection, FullListIsEmptiedAndFilledAgain) {
  const View view = viewOf(bumpyDepth(1.5), somePose());
  BlockSparseMap whole(compute(), mapParameters());
  int count = 0;
  const auto expected = keysOf(BlockRequests(whole).of(view, {1, 4, BlockRequests::kCapacity}, count));
  BlockSparseMap map(compute(), mapParameters());
  BlockRequests requests(map);
  const SelectionArgs short_list{1, 4, 17};
  size_t turns = 0;
  for (bool full = true; full; ++turns) {
    const std::vector<BlockIndex> blocks = requests.of(view, short_list, count);
    full = count > short_list.capacity;
    ASSERT_EQ(keysOf(blocks).size(), blocks.size());
    map.allocate(blocks);
    ASSERT_LE(turns, expected.size());
  }
  EXPECT_GE(turns, expected.size() / 17);
  std::set<BlockKey> allocated;
  for (const BlockSparseMap::Block& block : map.blocks()) allocated.insert(keyOf(block.index));
  EXPECT_EQ(allocated, expected);
}

std::set<int> visibleSlots(BlockSparseMap& map, const DepthFrame& frame, const Pose& T_W_D) {
  DeviceBuffer list(compute(), map.usage().capacity * sizeof(int), "visible");
  DeviceBuffer count(compute(), sizeof(int), "count");
  count.fill(0, sizeof(int));
  TsdfFusion::Kernels kernels(compute(), map.parameters());
  kernels.listVisibleBlocks(frame, map, list, count, T_W_D.inverse());
  const std::vector<int> slots = list.read<int>(count.read<int>(1).front());
  EXPECT_EQ(std::set<int>(slots.begin(), slots.end()).size(), slots.size()) << "a slot is listed twice";
  return {slots.begin(), slots.end()};
}

// Slots of the blocks of which the reference updates a voxel.
std::set<int> slotsToUpdate(BlockSparseMap& map, const View& view) {
  const int m = map.parameters().block_size;
  const Pose T_D_W = view.T_W_D.inverse();
  std::set<int> slots;
  for (const BlockSparseMap::Block& block : map.blocks()) {
    for (int i = 0; i < m * m * m; ++i) {
      const Measurement measured =
          measure(view, T_D_W, map.parameters(), fusionArgs(), block.index, voxelOf(block.index, i, m));
      if (measured.ambiguous || !measured.voxel.known) continue;
      slots.insert(block.slot);
      break;
    }
  }
  return slots;
}

void expectCoverage(const std::set<int>& visible, const std::set<int>& needed, size_t all) {
  EXPECT_GT(needed.size(), all / 50);
  EXPECT_TRUE(std::includes(visible.begin(), visible.end(), needed.begin(), needed.end()));
  EXPECT_LT(visible.size(), all - all / 4);
}

TEST_P(FusionOfBlockSize, ListsEveryBlockThatTheFrameUpdates) {
  const int blocks_per_axis = GetParam() < 16 ? 18 : 6;
  BlockSparseMap map(compute(),
                     mapParameters(GetParam(), blocks_per_axis, 2.4f / (blocks_per_axis * GetParam())));
  map.allocate(windowBlocks(map));
  for (const double turn : {0.0, 1.0, 4.0, -7.0}) {
    const View view = viewOf(bumpyDepth(0.9), somePose(turn));
    const std::set<int> visible =
        visibleSlots(map, frameOfDepth(compute(), view.camera, view.depth), view.T_W_D);
    expectCoverage(visible, slotsToUpdate(map, view), map.usage().blocks);
  }
}

TEST(BlockSelection, ListsEveryBlockThatAFilteredFrameUpdates) {
  BlockSparseMap map(compute(), mapParameters(8, 18, 0.016f));
  map.allocate(windowBlocks(map));
  cv::Mat noisy = bumpyDepth(1.0);
  cv::RNG random(2);
  reference::forEachPixel<float>(noisy, [&](int, int, float& pixel) { pixel += random.gaussian(0.004); });
  RgbdFrame input;
  input.depth = noisy;
  DepthPreprocessor preprocessor(compute(), {}, kCamera);
  const DepthFrame& frame = preprocessor.process(input);
  const View view = viewOf(readImage(frame.levels[0].depth, kCamera, 1), somePose());
  expectCoverage(visibleSlots(map, frame, view.T_W_D), slotsToUpdate(map, view), map.usage().blocks);
}

// How a byte may differ from the reference's number before it was rounded to the one below or above.
struct RoundingErrors {
  size_t updated = 0, skipped = 0, wrong = 0;
  double sum_steps = 0.0, sum_weights = 0.0;

  void add(const Voxel& expected, const Voxel& fused) {
    ++updated;
    const double error = fused.steps - expected.steps;
    const double weight_error = fused.weight - expected.weight;
    const bool good_steps = fused.known ? std::abs(error) < 1.02 : expected.steps > TSDF_MAX - 0.02;
    if (!good_steps || std::abs(weight_error) > 1.001) ++wrong;
    sum_weights += weight_error;
    if (fused.known) sum_steps += error;
  }
};

RoundingErrors compareWithReference(const MapContent& before, const MapContent& after, const View& view,
                                    const MapParameters& map) {
  RoundingErrors errors;
  const Pose T_D_W = view.T_W_D.inverse();
  const FusionArgs args = fusionArgs();
  for (const auto& [key, content] : after) {
    const auto old = before.find(key);
    for (size_t i = 0; i < content.distances.size(); ++i) {
      const BlockIndex block = indexOf(key);
      const Measurement measured =
          measure(view, T_D_W, map, args, block, voxelOf(block, static_cast<int>(i), map.block_size));
      const Voxel old_voxel = old == before.end() ? Voxel() : voxelOf(old->second, i);
      const Voxel fused = voxelOf(content, i);
      if (measured.ambiguous) {
        ++errors.skipped;
      } else if (measured.voxel.known) {
        errors.add(fuse(old_voxel, measured.voxel, args.max_weight), fused);
      } else if (fused.known != old_voxel.known || (fused.known && fused.steps != old_voxel.steps)) {
        ++errors.wrong;
      }
    }
  }
  return errors;
}

TEST_P(FusionOfBlockSize, EqualsTheReferenceFrameByFrame) {
  const MapParameters parameters = mapParameters(GetParam(), 18, 0.16f / GetParam());
  BlockSparseMap map(compute(), parameters);
  TsdfFusion fusion(compute(), map, {});
  MapContent before;
  for (int frame = 0; frame < 4; ++frame) {
    const View view = viewOf(bumpyDepth(1.1 + 0.01 * frame), somePose(1.0 - 0.1 * frame));
    integrate(fusion, view);
    const MapContent after = readMap(map);
    const RoundingErrors errors = compareWithReference(before, after, view, parameters);
    const double updated = static_cast<double>(errors.updated);
    EXPECT_GT(errors.updated, 5000u);
    EXPECT_EQ(errors.wrong, 0u) << "of " << errors.updated;
    EXPECT_LT(errors.skipped, errors.updated / 50);
    EXPECT_NEAR(errors.sum_steps / updated, 0.0, 0.02) << "rounding is biased";
    EXPECT_NEAR(errors.sum_weights / updated, 0.0, 0.02) << "rounding of weights is biased";
    before = after;
  }
}

struct Deviation {
  double mean = 0.0, spread = 0.0;
};

Deviation deviationOf(const std::vector<double>& values) {
  cv::Scalar mean, spread;
  cv::meanStdDev(values, mean, spread);
  return {mean[0], spread[0]};
}

struct TracedVoxel {
  BlockIndex block;
  int number;
  Voxel exact, nearest;
};

// Voxels before and behind a wall at 1 m, some of each block.
std::vector<TracedVoxel> voxelsToTrace(const BlockSparseMap& map) {
  const int m = map.parameters().block_size;
  std::vector<TracedVoxel> voxels;
  for (const BlockSparseMap::Block& block : map.blocks()) {
    for (int i = 0; i < m * m * m; i += 13) {
      if (std::abs(voxelOf(block.index, i, m).z() * map.parameters().voxel_size_m - 1.0) < 0.011) {
        voxels.push_back({block.index, i, {}, {}});
      }
    }
  }
  return voxels;
}

// A wall that stood at 1 m, long enough for all the weights to be at their bound, then moves by less than
// half a step a frame: 8 bits rounded to the nearest never notice.
TEST(TsdfFusion, EightBitsConvergeLikeFloats) {
  const MapParameters parameters = mapParameters(8, 32, 0.01f);
  BlockSparseMap map(compute(), parameters);
  TsdfFusion fusion(compute(), map, {});
  integrate(fusion, viewOf(wallDepth(1.0)));
  std::vector<TracedVoxel> voxels = voxelsToTrace(map);
  map.reset(Eigen::Vector3d::Zero());
  cv::RNG random(4);
  for (int frame = 0; frame < 450; ++frame) {
    cv::Mat depth = wallDepth(frame < 80 ? 1.0 : 1.004);
    reference::forEachPixel<float>(depth, [&](int, int, float& pixel) { pixel += random.gaussian(0.0005); });
    const View view = viewOf(depth);
    integrate(fusion, view);
    for (TracedVoxel& voxel : voxels) {
      const Voxel measured = measure(view, Pose::Identity(), parameters, fusionArgs(), voxel.block,
                                     voxelOf(voxel.block, voxel.number, parameters.block_size))
                                 .voxel;
      voxel.exact = fuse(voxel.exact, measured, 255.0);
      voxel.nearest = roundedToNearest(fuse(voxel.nearest, measured, 255.0));
    }
  }
  const MapContent content = readMap(map);
  std::vector<double> errors, errors_of_nearest;
  for (const TracedVoxel& voxel : voxels) {
    const auto block = content.find(keyOf(voxel.block));
    if (!voxel.exact.known || block == content.end()) continue;
    const Voxel fused = voxelOf(block->second, voxel.number);
    ASSERT_TRUE(fused.known);
    errors.push_back(fused.steps - voxel.exact.steps);
    errors_of_nearest.push_back(voxel.nearest.steps - voxel.exact.steps);
  }
  ASSERT_GT(errors.size(), 500u);
  EXPECT_NEAR(deviationOf(errors).mean, 0.0, 0.2);
  EXPECT_LT(deviationOf(errors).spread, 1.5);
  EXPECT_LT(deviationOf(errors_of_nearest).mean, -8.0) << "the test does not show what dither is for";
}

void expectDataInEveryBlock(BlockSparseMap& map) {
  for (const auto& [key, content] : readMap(map)) {
    const auto& distances = content.distances;
    ASSERT_TRUE(std::any_of(distances.begin(), distances.end(), [](int8_t d) { return d != TSDF_CHI; }))
        << indexOf(key).transpose();
  }
}

TEST(TsdfFusion, FreeSpaceClearsWhatStoodThere) {
  BlockSparseMap map(compute(), mapParameters());
  TsdfFusion fusion(compute(), map, {});
  for (int i = 0; i < 100; ++i) integrate(fusion, viewOf(wallDepth(1.0)));
  const size_t before = map.usage().blocks;
  ASSERT_GT(before, 40u);
  size_t released = 0;
  for (int i = 0; i < 100; ++i) released += integrate(fusion, viewOf(wallDepth(2.0))).blocks_released;
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

TEST(TsdfFusion, BlocksWithoutDataAreReleased) {
  BlockSparseMap map(compute(), mapParameters(4));
  TsdfFusion fusion(compute(), map, {});
  const FusionResult result = integrate(fusion, viewOf(bumpyDepth(1.5), somePose()));
  EXPECT_EQ(result.blocks_allocated, result.blocks_requested);
  EXPECT_EQ(map.usage().blocks, result.blocks_allocated - result.blocks_released);
  expectDataInEveryBlock(map);
  std::vector<int> offsets = map.offsets().read<int>(map.offsets().bytes() / sizeof(int));
  EXPECT_EQ(map.usage().blocks, offsets.size() - std::count(offsets.begin(), offsets.end(), BLOCK_EMPTY));
}

TEST(TsdfFusion, NoDepthChangesNothing) {
  BlockSparseMap map(compute(), mapParameters());
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
  BlockSparseMap map(compute(), parameters);
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
  BlockSparseMap map(compute(), parameters);
  map.reset(Eigen::Vector3d(0.0, 0.0, 3.0));
  TsdfFusion fusion(compute(), map, {});
  const View wall{camera, Pose::Identity(), cv::Mat(camera.height, camera.width, CV_32FC1, cv::Scalar(3.0))};
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
    BlockSparseMap map(compute(), parameters);
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
  BlockSparseMap map(compute(), parameters);
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

}  // namespace
}  // namespace depth_fusion
