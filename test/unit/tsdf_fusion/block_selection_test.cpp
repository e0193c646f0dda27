#include <gtest/gtest.h>

#include "support/fusion_views.h"
#include "tsdf_fusion/tsdf_fusion_kernels.h"

namespace depth_fusion {
namespace {

std::vector<BlockIndex> windowBlocks(const BlockMap& map) {
  const int n = map.parameters().blocks_per_axis;
  std::vector<BlockIndex> blocks;
  for (int i = 0; i < n * n * n; ++i)
    blocks.push_back(map.window().origin + BlockIndex(i % n, i / n % n, i / n / n));
  return blocks;
}

bool inWindow(const BlockMap& map, const BlockKey& key) {
  const Eigen::Array3i local = (indexOf(key) - map.window().origin).array();
  return (local >= 0).all() && (local < map.parameters().blocks_per_axis).all();
}

class BlockRequests {
 public:
  explicit BlockRequests(BlockMap& map)
      : map_(map),
        kernels_(compute(), map),
        list_(compute(), kCapacity * 4 * sizeof(int), "requests"),
        count_(compute(), sizeof(int), "count"),
        points_outside_(compute(), sizeof(int), "count") {}

  // The blocks that the kernel lists; count is what it counted.
  std::vector<BlockIndex> of(const View& view, SelectionArgs args, int& count) {
    count_.fill(0, sizeof(int));
    points_outside_.fill(0, sizeof(int));
    const DepthFrame frame = frameOf(view);
    kernels_.requestBlocks(frame, map_, list_, count_, points_outside_, view.T_W_D, args);
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
  BlockMap& map_;
  TsdfFusion::Kernels kernels_;
  DeviceBuffer list_, count_, points_outside_;
};

std::set<BlockKey> keysOf(const std::vector<BlockIndex>& blocks) {
  std::set<BlockKey> keys;
  for (const BlockIndex& block : blocks) keys.insert(keyOf(block));
  return keys;
}

// Every block of the reference in the window, but for those that rounding decides, and no other.
void expectRequests(const BlockMap& map, const View& view, const SelectionArgs& args,
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

class SelectionOfBlockSize : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(BlockSizes, SelectionOfBlockSize, testing::Values(4, 8, 16, 32));

TEST_P(SelectionOfBlockSize, RequestsTheBlocksInTheTruncationBands) {
  const MapParameters parameters = mapParameters(GetParam(), 37, 0.16f / GetParam());
  for (const Eigen::Vector3d& centre : {Eigen::Vector3d(0, 0, 0), {2.1, -1.3, 3.9}, {-2.9, 0.2, 0.7}}) {
    for (const int stride : {1, 3}) {
      BlockMap map(compute(), parameters);
      map.reset(centre);  // part of the surface lies outside of the window
      const SelectionArgs args{stride, stride == 1 ? 0.0f : 2.0f, 4, BlockRequests::kCapacity};
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
  BlockMap map(compute(), mapParameters());
  BlockRequests requests(map);
  const View view = viewOf(bumpyDepth(1.5), somePose());
  const SelectionArgs args{1, 0.0f, 4, BlockRequests::kCapacity};
  int count = 0;
  const std::vector<BlockIndex> blocks = requests.of(view, args, count);
  EXPECT_EQ(map.allocate(blocks), blocks.size());
  EXPECT_TRUE(requests.of(view, args, count).empty());
}

TEST(BlockSelection, FullListIsEmptiedAndFilledAgain) {
  const View view = viewOf(bumpyDepth(1.5), somePose());
  BlockMap whole(compute(), mapParameters());
  int count = 0;
  const auto expected = keysOf(BlockRequests(whole).of(view, {1, 0.0f, 4, BlockRequests::kCapacity}, count));
  BlockMap map(compute(), mapParameters());
  BlockRequests requests(map);
  const SelectionArgs short_list{1, 0.0f, 4, 17};
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
  for (const SlotTable::Block& block : map.slots().blocks()) allocated.insert(keyOf(block.index));
  EXPECT_EQ(allocated, expected);
}

std::set<int> visibleSlots(BlockMap& map, const DepthFrame& frame, const Pose& T_W_D) {
  DeviceBuffer list(compute(), map.usage().capacity * sizeof(int), "visible");
  DeviceBuffer count(compute(), sizeof(int), "count");
  count.fill(0, sizeof(int));
  TsdfFusion::Kernels kernels(compute(), map);
  kernels.listVisibleBlocks(frame, map, list, count, T_W_D.inverse());
  const std::vector<int> slots = list.read<int>(count.read<int>(1).front());
  EXPECT_EQ(std::set<int>(slots.begin(), slots.end()).size(), slots.size()) << "a slot is listed twice";
  return {slots.begin(), slots.end()};
}

// Slots of the blocks of which the reference updates a voxel.
std::set<int> slotsToUpdate(BlockMap& map, const View& view) {
  const int m = map.parameters().block_size;
  const Pose T_D_W = view.T_W_D.inverse();
  std::set<int> slots;
  for (const SlotTable::Block& block : map.slots().blocks()) {
    for (int i = 0; i < m * m * m; ++i) {
      const Measurement measured = measure(view, T_D_W, map.parameters(), TsdfFusionParameters(), block.index,
                                           voxelOf(block.index, i, m));
      if (measured.ambiguous || measured.kind == Measurement::kNone) continue;
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

TEST_P(SelectionOfBlockSize, ListsEveryBlockThatTheFrameUpdates) {
  const int blocks_per_axis = GetParam() < 16 ? 18 : 6;
  BlockMap map(compute(), mapParameters(GetParam(), blocks_per_axis, 2.4f / (blocks_per_axis * GetParam())));
  map.allocate(windowBlocks(map));
  for (const double turn : {0.0, 1.0, 4.0, -7.0}) {
    const View view = viewOf(bumpyDepth(0.9), somePose(turn));
    const std::set<int> visible = visibleSlots(map, frameOf(view), view.T_W_D);
    expectCoverage(visible, slotsToUpdate(map, view), map.usage().blocks);
  }
}

TEST(BlockSelection, ListsNoBlockFarBesideTheCamera) {
  BlockMap map(compute(), mapParameters(8, 18, 0.016f));
  map.allocate(windowBlocks(map));
  const View view = viewOf(bumpyDepth(0.9), Pose::Identity());  // in the middle of the window
  const double block_m = 8 * 0.016;
  const std::set<int> visible = visibleSlots(map, frameOf(view), view.T_W_D);
  for (const SlotTable::Block& block : map.slots().blocks()) {
    const Eigen::Vector3d centre = block_m * (block.index.cast<double>() + Eigen::Vector3d::Constant(0.5));
    const bool beside = std::abs(centre.z()) < block_m && centre.head<2>().norm() > 4.0 * block_m;
    EXPECT_FALSE(beside && visible.count(block.slot)) << block.index.transpose();
  }
}

TEST(BlockSelection, ListsWhatIsSeenThroughAGap) {
  BlockMap map(compute(), mapParameters(8, 18, 0.016f));
  map.allocate(windowBlocks(map));
  cv::Mat depth = bumpyDepth(0.5);
  depth(cv::Rect(64, 48, DEPTH_TILE, DEPTH_TILE)).setTo(1.0);
  const View view = viewOf(depth, Pose::Identity());
  const std::set<int> visible = visibleSlots(map, frameOf(view), view.T_W_D),
                      needed = slotsToUpdate(map, view);
  EXPECT_TRUE(std::includes(visible.begin(), visible.end(), needed.begin(), needed.end()));
}

TEST(BlockSelection, ListsNoBlockHiddenBehindTheSurface) {
  BlockMap map(compute(), mapParameters(8, 18, 0.016f));
  map.allocate(windowBlocks(map));
  const View view = viewOf(bumpyDepth(0.5), Pose::Identity());
  double farthest_m = 0.0;
  cv::minMaxLoc(view.depth, nullptr, &farthest_m);
  const double block_m = 8 * 0.016;
  const double hidden_m = farthest_m + 2.0 * map.parameters().truncation_m + std::sqrt(0.75) * block_m;
  const std::set<int> visible = visibleSlots(map, frameOf(view), view.T_W_D);
  size_t hidden = 0;
  for (const SlotTable::Block& block : map.slots().blocks()) {
    if (block_m * (block.index.z() + 0.5) < hidden_m + 1e-3) continue;
    ++hidden;
    EXPECT_EQ(visible.count(block.slot), 0u) << block.index.transpose();
  }
  EXPECT_GT(hidden, 300u);
}

TEST(BlockSelection, ListsEveryBlockThatAFilteredFrameUpdates) {
  BlockMap map(compute(), mapParameters(8, 18, 0.016f));
  map.allocate(windowBlocks(map));
  cv::Mat noisy = bumpyDepth(1.0);
  cv::RNG random(2);
  reference::forEachPixel<float>(noisy, [&](int, int, float& pixel) { pixel += random.gaussian(0.004); });
  RgbdFrame input;
  input.depth = noisy;
  DepthPreprocessor preprocessor(compute(), {}, kCamera);
  const DepthFrame& frame = preprocessor.process(input);
  View view = viewOf(readImage(frame.levels[0].depth, kCamera), somePose());
  expectCoverage(visibleSlots(map, frame, view.T_W_D), slotsToUpdate(map, view), map.usage().blocks);
}

}  // namespace
}  // namespace depth_fusion
