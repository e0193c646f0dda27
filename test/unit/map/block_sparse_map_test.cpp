#include "depth_fusion/map/block_sparse_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>

#include "depth_fusion/common/error.h"
#include "shared/types.h"

namespace depth_fusion {
namespace {

using BlockIndex = BlockSparseMap::BlockIndex;

ComputeContext& compute() {
  static ComputeContext context;
  return context;
}

MapParameters mapParameters(int blocks_per_axis, int block_size, int pool_mib) {
  MapParameters parameters;
  parameters.voxel_size_m = 0.01f;
  parameters.truncation_m = 0.04f;
  parameters.blocks_per_axis = blocks_per_axis;
  parameters.block_size = block_size;
  parameters.pool_mib = pool_mib;
  return parameters;
}

// Reference of the addresses: the index modulo N in each axis.
size_t address(const BlockIndex& block, int n) {
  const auto wrap = [n](int i) { return static_cast<size_t>(((i % n) + n) % n); };
  return wrap(block.x()) + n * (wrap(block.y()) + n * wrap(block.z()));
}

// All the blocks of the window, in an order of no meaning.
std::vector<BlockIndex> windowBlocks(const BlockSparseMap& map) {
  const int n = map.parameters().blocks_per_axis;
  std::vector<BlockIndex> blocks;
  for (int i = 0; i < n * n * n; ++i)
    blocks.push_back(map.origin() + BlockIndex(i % n, i / n % n, i / n / n));
  std::shuffle(blocks.begin(), blocks.end(), std::mt19937(1));
  return blocks;
}

std::vector<int> readOffsets(BlockSparseMap& map) {
  return map.offsets().read<int>(map.offsets().bytes() / sizeof(int));
}

// Allocates as after block selection, which has marked the blocks.
size_t allocate(BlockSparseMap& map, const std::vector<BlockIndex>& blocks) {
  std::vector<int> offsets = readOffsets(map);
  for (const BlockIndex& block : blocks)
    offsets[address(block, map.parameters().blocks_per_axis)] = BLOCK_REQUESTED;
  map.offsets().write(offsets);
  return map.allocate(blocks);
}

void expectConsistent(BlockSparseMap& map) {
  const int n = map.parameters().blocks_per_axis;
  const std::vector<int> offsets = readOffsets(map);
  const std::vector<int> indices = map.blockIndices().read<int>(4 * map.slotBound());
  std::vector<int> expected(offsets.size(), BLOCK_EMPTY);
  for (const BlockSparseMap::Block& block : map.blocks()) {
    expected[address(block.index, n)] = block.slot;
    const int* entry = &indices[4 * block.slot];
    ASSERT_EQ(BlockIndex(entry[0], entry[1], entry[2]), block.index);
    ASSERT_EQ(entry[3], 1);
  }
  EXPECT_EQ(offsets, expected);
}

void expectCleared(BlockSparseMap& map) {
  const int m = map.parameters().block_size;
  const size_t voxels = static_cast<size_t>(m) * m * m;
  const std::vector<signed char> empty_distances(voxels, TSDF_CHI);
  const std::vector<signed char> no_weights(voxels, 0);
  for (const BlockSparseMap::Block& block : map.blocks()) {
    ASSERT_EQ(map.voxels().read<signed char>(voxels, 2 * voxels * block.slot), empty_distances);
    ASSERT_EQ(map.voxels().read<signed char>(voxels, 2 * voxels * block.slot + voxels), no_weights);
  }
}

TEST(BlockSparseMap, WindowIsCentredOnThePoint) {
  BlockSparseMap map(compute(), mapParameters(10, 8, 1));
  EXPECT_EQ(map.origin(), BlockIndex(-5, -5, -5));
  map.reset(Eigen::Vector3d(0.81, -0.01, -7.99));  // blocks of 8 cm
  EXPECT_EQ(map.origin(), BlockIndex(10 - 5, -1 - 5, -100 - 5));
}

TEST(BlockSparseMap, AddressesWrapAroundWhereverTheWindowStands) {
  for (const int n : {7, 8, 12}) {
    BlockSparseMap map(compute(), mapParameters(n, 8, 2));
    for (const double centre_m : {0.0, -0.05, 3.3, -123.4}) {
      map.reset(Eigen::Vector3d(centre_m, -2.0 * centre_m, 0.5 * centre_m));
      const std::vector<BlockIndex> blocks = windowBlocks(map);
      ASSERT_EQ(allocate(map, blocks), blocks.size());
      expectConsistent(map);
    }
  }
}

TEST(BlockSparseMap, FullPoolMeetsTheFirstAndWithdrawsTheRest) {
  BlockSparseMap map(compute(), mapParameters(30, 4, 3));  // more than one upload of requests
  const size_t capacity = 3 * (1 << 20) / (2 * 4 * 4 * 4);
  const std::vector<BlockIndex> blocks = windowBlocks(map);
  ASSERT_GT(blocks.size(), capacity);
  EXPECT_EQ(allocate(map, blocks), capacity);
  EXPECT_EQ(map.usage().blocks, capacity);
  expectConsistent(map);
  const std::vector<int> offsets = readOffsets(map);
  for (size_t i = 0; i < blocks.size(); ++i) {
    ASSERT_EQ(offsets[address(blocks[i], 30)] == BLOCK_EMPTY, i >= capacity) << i;
  }
  EXPECT_EQ(allocate(map, {blocks.back()}), 0u);
  expectConsistent(map);
}

TEST(BlockSparseMap, AllocatedBlocksHoldChiAndNoWeight) {
  for (const int m : {4, 8, 16, 32}) {
    BlockSparseMap map(compute(), mapParameters(2, m, 1));
    map.voxels().fill(0x5a5a5a5a, map.voxels().bytes());
    EXPECT_EQ(allocate(map, windowBlocks(map)), 8u);
    expectCleared(map);
  }
}

TEST(BlockSparseMap, ReleasedSlotsServeAgainAndComeClean) {
  BlockSparseMap map(compute(), mapParameters(3, 32, 1));  // room for 16 of 27 blocks
  const std::vector<BlockIndex> blocks = windowBlocks(map);
  ASSERT_EQ(allocate(map, blocks), 16u);
  map.voxels().fill(0x5a5a5a5a, map.voxels().bytes());
  std::vector<int> slots;
  for (const BlockSparseMap::Block& block : map.blocks()) slots.push_back(block.slot);
  map.offsets().fill(BLOCK_EMPTY, map.offsets().bytes());
  map.release(slots);
  EXPECT_EQ(map.usage().blocks, 0u);
  EXPECT_TRUE(map.blocks().empty());
  EXPECT_EQ(allocate(map, {blocks.end() - 12, blocks.end()}), 12u);
  EXPECT_LE(map.slotBound(), 16);
  expectConsistent(map);
  expectCleared(map);
}

TEST(BlockSparseMap, RefusesToReleaseWhatIsNotInUse) {
  BlockSparseMap map(compute(), mapParameters(3, 8, 1));
  allocate(map, {BlockIndex(0, 0, 0)});
  const int slot = map.blocks().front().slot;
  EXPECT_THROW(map.release({slot + 1}), Error);
  EXPECT_THROW(map.release({-1}), Error);
  map.release({slot});
  EXPECT_THROW(map.release({slot}), Error);
}

TEST(BlockSparseMap, BlocksAreSortedByZYX) {
  BlockSparseMap map(compute(), mapParameters(6, 8, 1));
  allocate(map, windowBlocks(map));
  const std::vector<BlockSparseMap::Block> blocks = map.blocks();
  ASSERT_EQ(blocks.size(), 216u);
  const auto key = [](const BlockIndex& b) { return std::make_tuple(b.z(), b.y(), b.x()); };
  for (size_t i = 1; i < blocks.size(); ++i) ASSERT_LT(key(blocks[i - 1].index), key(blocks[i].index));
}

TEST(BlockSparseMap, UsageIsThePapersFormula) {
  BlockSparseMap map(compute(), mapParameters(10, 8, 1));
  EXPECT_EQ(map.usage().blocks, 0u);
  EXPECT_EQ(map.usage().bytes, 4u * 10 * 10 * 10);
  EXPECT_EQ(map.usage().capacity, 1000u);  // 1 MiB would hold 1024, the window has 1000
  allocate(map, {BlockIndex(1, 2, 3), BlockIndex(-5, 4, 0), BlockIndex(0, 0, 0)});
  EXPECT_EQ(map.usage().blocks, 3u);
  EXPECT_EQ(map.usage().bytes, 2u * 3 * 8 * 8 * 8 + 4u * 10 * 10 * 10);
  EXPECT_EQ(map.usage().pool_bytes, map.offsets().bytes() + map.voxels().bytes() +
                                        map.blockIndices().bytes() + map.blockStates().bytes());
}

TEST(BlockSparseMap, ResetEmptiesIt) {
  BlockSparseMap map(compute(), mapParameters(5, 8, 1));
  allocate(map, windowBlocks(map));
  map.reset(Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(map.usage().blocks, 0u);
  EXPECT_EQ(map.slotBound(), 0);
  EXPECT_TRUE(map.blocks().empty());
  expectConsistent(map);
  EXPECT_EQ(allocate(map, windowBlocks(map)), 125u);
  expectConsistent(map);
}

TEST(BlockSparseMap, RefusesParametersThatDoNotFit) {
  EXPECT_THROW(BlockSparseMap(compute(), mapParameters(10, 12, 1)), Error);  // no power of two
  EXPECT_THROW(BlockSparseMap(compute(), mapParameters(0, 8, 1)), Error);
  MapParameters thin = mapParameters(10, 8, 1);
  thin.truncation_m = 0.015f;
  EXPECT_THROW(BlockSparseMap(compute(), thin), Error);
}

}  // namespace
}  // namespace depth_fusion
