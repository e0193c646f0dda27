#include "depth_fusion/map/block_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <tuple>

#include "depth_fusion/common/error.h"
#include "shared/types.h"

namespace depth_fusion {
namespace {

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
std::vector<BlockIndex> windowBlocks(const BlockMap& map) {
  const int n = map.parameters().blocks_per_axis;
  std::vector<BlockIndex> blocks;
  for (int i = 0; i < n * n * n; ++i)
    blocks.push_back(map.window().origin + BlockIndex(i % n, i / n % n, i / n / n));
  std::shuffle(blocks.begin(), blocks.end(), std::mt19937(1));
  return blocks;
}

std::vector<int> readOffsets(BlockMap& map) {
  return map.offsets().read<int>(map.offsets().bytes() / sizeof(int));
}

// Allocates as after block selection, which has marked the blocks.
size_t allocate(BlockMap& map, const std::vector<BlockIndex>& blocks) {
  std::vector<int> offsets = readOffsets(map);
  for (const BlockIndex& block : blocks)
    offsets[address(block, map.parameters().blocks_per_axis)] = BLOCK_REQUESTED;
  map.offsets().write(offsets);
  return map.allocate(blocks);
}

void expectConsistent(BlockMap& map) {
  const int n = map.parameters().blocks_per_axis;
  const std::vector<int> offsets = readOffsets(map);
  const std::vector<int> indices = map.blockIndices().read<int>(4 * map.slots().bound());
  std::vector<int> expected(offsets.size(), BLOCK_EMPTY);
  for (const SlotTable::Block& block : map.slots().blocks()) {
    expected[address(block.index, n)] = block.slot;
    const int* entry = &indices[4 * block.slot];
    ASSERT_EQ(BlockIndex(entry[0], entry[1], entry[2]), block.index);
    ASSERT_EQ(entry[3], 1);
  }
  EXPECT_EQ(offsets, expected);
}

void expectCleared(BlockMap& map) {
  const int m = map.parameters().block_size;
  const size_t voxels = static_cast<size_t>(m) * m * m;
  const std::vector<signed char> empty_distances(voxels, TSDF_CHI);
  const std::vector<signed char> no_weights(voxels, 0);
  for (const SlotTable::Block& block : map.slots().blocks()) {
    ASSERT_EQ(map.layer(kTsdfLayer).read<signed char>(voxels, 2 * voxels * block.slot), empty_distances);
    ASSERT_EQ(map.layer(kTsdfLayer).read<signed char>(voxels, 2 * voxels * block.slot + voxels), no_weights);
  }
}

TEST(BlockMap, WindowIsCentredOnThePoint) {
  BlockMap map(compute(), mapParameters(10, 8, 1));
  EXPECT_EQ(map.window().origin, BlockIndex(-5, -5, -5));
  map.reset(Eigen::Vector3d(0.81, -0.01, -7.99));  // blocks of 8 cm
  EXPECT_EQ(map.window().origin, BlockIndex(10 - 5, -1 - 5, -100 - 5));
}

TEST(BlockMap, AddressesWrapAroundWhereverTheWindowStands) {
  for (const int n : {7, 8, 12}) {
    BlockMap map(compute(), mapParameters(n, 8, 2));
    for (const double centre_m : {0.0, -0.05, 3.3, -123.4}) {
      map.reset(Eigen::Vector3d(centre_m, -2.0 * centre_m, 0.5 * centre_m));
      const std::vector<BlockIndex> blocks = windowBlocks(map);
      ASSERT_EQ(allocate(map, blocks), blocks.size());
      expectConsistent(map);
    }
  }
}

TEST(BlockMap, FullPoolMeetsTheFirstAndWithdrawsTheRest) {
  BlockMap map(compute(), mapParameters(30, 4, 3));  // more than one upload of requests
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

TEST(BlockMap, AllocatedBlocksHoldChiAndNoWeight) {
  for (const int m : {4, 8, 16, 32}) {
    BlockMap map(compute(), mapParameters(2, m, 1));
    map.layer(kTsdfLayer).fill(0x5a5a5a5a, map.layer(kTsdfLayer).bytes());
    EXPECT_EQ(allocate(map, windowBlocks(map)), 8u);
    expectCleared(map);
  }
}

// A map with every layer that there is.
MapParameters everyLayer(int block_size) {
  MapParameters parameters = mapParameters(2, block_size, 1);
  parameters.color = true;
  return parameters;
}

// The bytes of a block of which nothing is known, as its row says.
std::vector<uint8_t> clearBlock(const LayerRow& row, int voxels) {
  std::vector<uint8_t> bytes;
  for (const LayerPlane& plane : row.planes) {
    for (int voxel = 0; voxel < voxels; ++voxel) {
      for (size_t byte = 0; byte < plane.bytes_per_voxel; ++byte)
        bytes.push_back(static_cast<uint8_t>(static_cast<uint32_t>(plane.clear_value) >> (8 * byte)));
    }
  }
  return bytes;
}

TEST(BlockMap, AllocatedBlocksAreClearInEveryLayer) {
  for (const int m : {4, 8, 32}) {
    BlockMap map(compute(), everyLayer(m));
    for (const LayerRow& row : layersOf(map.parameters()))
      map.layer(row.name).fill(0x5a5a5a5a, map.layer(row.name).bytes());
    ASSERT_EQ(allocate(map, windowBlocks(map)), 8u);
    for (const LayerRow& row : layersOf(map.parameters())) {
      const std::vector<uint8_t> expected = clearBlock(row, m * m * m);
      for (size_t slot = 0; slot < 8; ++slot)
        ASSERT_EQ(map.layer(row.name).read<uint8_t>(expected.size(), slot * expected.size()), expected)
            << row.name;
    }
  }
}

TEST(BlockMap, NothingIsKnownOfANewVoxel) {
  BlockMap map(compute(), everyLayer(8));
  map.layer(kColorLayer).fill(0x5a5a5a5a, map.layer(kColorLayer).bytes());
  ASSERT_EQ(allocate(map, windowBlocks(map)), 8u);
  expectCleared(map);
  EXPECT_EQ(map.layer(kColorLayer).read<uint32_t>(8 * 512), std::vector<uint32_t>(8 * 512, 0));
}

TEST(BlockMap, SnapshotKeepsEveryLayerWhileTheMapGoesOn) {
  BlockMap map(compute(), everyLayer(8));
  allocate(map, windowBlocks(map));
  std::map<std::string, std::vector<uint8_t>> contents;
  std::vector<std::string> names;
  std::mt19937 random(4);
  for (const LayerRow& row : layersOf(map.parameters())) {
    std::vector<uint8_t>& content = contents[row.name];
    content.resize(8 * row.bytesPerBlock(8));
    std::generate(content.begin(), content.end(), [&] { return static_cast<uint8_t>(random()); });
    map.layer(row.name).write(content.data(), content.size(), 0);
    names.push_back(row.name);
  }
  const std::vector<int> states = {0, 1, 2, 3, 3, 2, 1, 0};
  map.blockStates().write(states);
  const auto copy = map.snapshot(names);
  map.blockStates().fill(0, map.blockStates().bytes());
  for (const std::string& name : names) map.layer(name).fill(0, map.layer(name).bytes());
  for (const std::string& name : names)
    EXPECT_EQ(copy->layer(name).read<uint8_t>(contents[name].size()), contents[name]) << name;
  EXPECT_EQ(copy->blockStates().read<int>(8), states);
  expectConsistent(*copy);
}

TEST(BlockMap, LayersAreThoseOfTheParameters) {
  MapParameters parameters = mapParameters(4, 8, 1);
  BlockMap plain(compute(), parameters);
  EXPECT_TRUE(plain.hasLayer(kTsdfLayer));
  EXPECT_FALSE(plain.hasLayer(kColorLayer));
  EXPECT_THROW(plain.layer(kColorLayer), Error);
  parameters.color = true;
  BlockMap colored(compute(), parameters);
  EXPECT_TRUE(colored.hasLayer(kColorLayer));
  allocate(colored, {BlockIndex(0, 0, 0)});
  const auto copy = colored.snapshot({kTsdfLayer});
  EXPECT_FALSE(copy->hasLayer(kColorLayer));
  EXPECT_EQ(copy->usage().bytesOf(kTsdfLayer), 2u * 512);
  EXPECT_EQ(copy->usage().bytesOf(kColorLayer), 0u);
}

// What a follower is told is what happened, block by block.
TEST(BlockMap, TellsItsFollowersOfWhatItDoes) {
  BlockMap map(compute(), mapParameters(4, 8, 1));
  EXPECT_FALSE(map.isFollowed());
  MapSubscription follower = map.follow();
  EXPECT_TRUE(map.isFollowed());
  follower.take();
  allocate(map, {BlockIndex(0, 0, 0), BlockIndex(1, 0, 0)});
  EXPECT_EQ(follower.take().updated, (std::vector<BlockIndex>{{0, 0, 0}, {1, 0, 0}}));
  const SlotTable::Block gone = map.slots().blocks().front();
  map.release({gone.slot});
  EXPECT_EQ(follower.take().released, (std::vector<BlockIndex>{gone.index}));
  const uint32_t generation = map.generation();
  map.reset({1.0, 0.0, 0.0});
  EXPECT_NE(map.generation(), generation);
  const MapChanges anew = follower.take();
  EXPECT_EQ(anew.generation, map.generation());
  EXPECT_TRUE(anew.complete && anew.updated.empty());
}

TEST(BlockMap, EvictedBlocksLeaveAndOthersStayWhereTheWindowMoves) {
  BlockMap map(compute(), mapParameters(4, 8, 1));
  const BlockIndex origin = map.window().origin;
  const std::vector<BlockIndex> blocks = {origin, origin + BlockIndex(3, 3, 3), origin + BlockIndex(2, 1, 0)};
  ASSERT_EQ(allocate(map, blocks), 3u);
  const int first = map.slots().blocks().front().slot;
  ASSERT_EQ(map.slots().blockOf(first), origin);
  EXPECT_THROW(map.moveWindow(origin + BlockIndex(1, 0, 0)), Error)
      << "it would leave the first block behind";
  map.evict({first});
  map.moveWindow(origin + BlockIndex(2, 0, 0));
  EXPECT_EQ(map.usage().blocks, 2u);
  expectConsistent(map);
  ASSERT_EQ(allocate(map, {origin + BlockIndex(5, 3, 2)}), 1u);
  expectConsistent(map);
}

TEST(BlockMap, ContentsOfSlotsGoOutAndIn) {
  MapParameters parameters = mapParameters(32, 8, 8);
  parameters.color = true;
  BlockMap map(compute(), parameters);
  std::vector<BlockIndex> blocks = windowBlocks(map);
  blocks.resize(5000);  // several transfers
  const std::vector<int> slots = map.insert(blocks);
  std::mt19937 random(7);
  for (const char* layer : {kTsdfLayer, kColorLayer}) {
    std::string voxels(slots.size() * 512 * (layer == kTsdfLayer ? 2 : 4), '\0');
    for (char& byte : voxels) byte = static_cast<char>(random());
    map.setVoxels(layer, slots, voxels);
    EXPECT_EQ(map.voxels(layer, slots), voxels);
    const std::vector<int> some = {slots[4999], slots[17], slots[2500]};
    const size_t bytes = voxels.size() / slots.size();
    EXPECT_EQ(map.voxels(layer, some), voxels.substr(4999 * bytes, bytes) + voxels.substr(17 * bytes, bytes) +
                                           voxels.substr(2500 * bytes, bytes));
  }
  std::vector<int> states;
  for (size_t i = 0; i < slots.size(); ++i) states.push_back(static_cast<int>(random() % 512));
  map.setStates(slots, states);
  EXPECT_EQ(map.states(slots), states);
}

TEST(BlockMap, AsksForBlocksThatAreKeptElsewhereBeforeItMakesThem) {
  BlockMap map(compute(), mapParameters(4, 8, 1));
  const BlockIndex kept(0, 0, 0), made(1, 0, 0), away(0, 1, 0);
  map.bringBackBy([&](std::vector<BlockIndex>& requested) {
    EXPECT_EQ(requested.size(), 3u);
    map.insert({kept});
    requested = {made};
    return std::vector<BlockIndex>{away};
  });
  EXPECT_EQ(allocate(map, {kept, made, away}), 2u);
  EXPECT_EQ(map.usage().blocks, 2u);
  expectConsistent(map);
}

TEST(BlockMap, PlacesTheWindowOfAnEmptyMapOnly) {
  BlockMap map(compute(), mapParameters(4, 8, 1));
  const uint32_t generation = map.generation();
  map.placeWindow({0.81, 0.0, 0.0});
  EXPECT_EQ(map.window().origin, BlockIndex(8, -2, -2));
  EXPECT_EQ(map.generation(), generation);
  allocate(map, {BlockIndex(9, 0, 0)});
  EXPECT_THROW(map.placeWindow({0.0, 0.0, 0.0}), Error);
}

TEST(BlockMap, ReleasedSlotsServeAgainAndComeClean) {
  BlockMap map(compute(), mapParameters(3, 32, 1));  // room for 16 of 27 blocks
  const std::vector<BlockIndex> blocks = windowBlocks(map);
  ASSERT_EQ(allocate(map, blocks), 16u);
  map.layer(kTsdfLayer).fill(0x5a5a5a5a, map.layer(kTsdfLayer).bytes());
  std::vector<int> slots;
  for (const SlotTable::Block& block : map.slots().blocks()) slots.push_back(block.slot);
  map.offsets().fill(BLOCK_EMPTY, map.offsets().bytes());
  map.release(slots);
  EXPECT_EQ(map.usage().blocks, 0u);
  EXPECT_TRUE(map.slots().blocks().empty());
  EXPECT_EQ(allocate(map, {blocks.end() - 12, blocks.end()}), 12u);
  EXPECT_LE(map.slots().bound(), 16);
  expectConsistent(map);
  expectCleared(map);
}

TEST(BlockMap, RefusesToReleaseWhatIsNotInUse) {
  BlockMap map(compute(), mapParameters(3, 8, 1));
  allocate(map, {BlockIndex(0, 0, 0)});
  const int slot = map.slots().blocks().front().slot;
  EXPECT_THROW(map.release({slot + 1}), Error);
  EXPECT_THROW(map.release({-1}), Error);
  map.release({slot});
  EXPECT_THROW(map.release({slot}), Error);
}

TEST(BlockMap, BlocksAreSortedByZYX) {
  BlockMap map(compute(), mapParameters(6, 8, 1));
  allocate(map, windowBlocks(map));
  const std::vector<SlotTable::Block> blocks = map.slots().blocks();
  ASSERT_EQ(blocks.size(), 216u);
  const auto key = [](const BlockIndex& b) { return std::make_tuple(b.z(), b.y(), b.x()); };
  for (size_t i = 1; i < blocks.size(); ++i) ASSERT_LT(key(blocks[i - 1].index), key(blocks[i].index));
}

TEST(BlockMap, UsageIsThePapersFormula) {
  BlockMap map(compute(), mapParameters(10, 8, 1));
  EXPECT_EQ(map.usage().blocks, 0u);
  EXPECT_EQ(map.usage().bytes, 4u * 10 * 10 * 10);
  EXPECT_EQ(map.usage().capacity, 1000u);  // 1 MiB would hold 1024, the window has 1000
  allocate(map, {BlockIndex(1, 2, 3), BlockIndex(-5, 4, 0), BlockIndex(0, 0, 0)});
  EXPECT_EQ(map.usage().blocks, 3u);
  EXPECT_EQ(map.usage().bytes, 2u * 3 * 8 * 8 * 8 + 4u * 10 * 10 * 10);
  EXPECT_EQ(map.usage().pool_bytes, map.offsets().bytes() + map.layer(kTsdfLayer).bytes() +
                                        map.blockIndices().bytes() + map.blockStates().bytes());
}

TEST(BlockMap, ResetEmptiesIt) {
  BlockMap map(compute(), mapParameters(5, 8, 1));
  allocate(map, windowBlocks(map));
  map.reset(Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(map.usage().blocks, 0u);
  EXPECT_EQ(map.slots().bound(), 0);
  EXPECT_TRUE(map.slots().blocks().empty());
  expectConsistent(map);
  EXPECT_EQ(allocate(map, windowBlocks(map)), 125u);
  expectConsistent(map);
}

TEST(BlockMap, RefusesParametersThatDoNotFit) {
  EXPECT_THROW(BlockMap(compute(), mapParameters(10, 12, 1)), Error);  // no power of two
  EXPECT_THROW(BlockMap(compute(), mapParameters(0, 8, 1)), Error);
  MapParameters thin = mapParameters(10, 8, 1);
  thin.truncation_m = 0.015f;
  EXPECT_THROW(BlockMap(compute(), thin), Error);
}

}  // namespace
}  // namespace depth_fusion
