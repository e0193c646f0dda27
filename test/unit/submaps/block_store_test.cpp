#include "submaps/block_store.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <thread>

#include "support/expect_error.h"
#include "support/full_disk.h"
#include "support/postgres_server.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

constexpr int kBlockSize = 8;

std::vector<LayerRow> layers() {
  MapParameters parameters;
  parameters.color = true;
  return layersOf(parameters);
}

// A group of some blocks, which is another one for each key and round. Its bytes do not compress.
BlockGroups groupOf(const GroupKey& key, uint32_t round = 0) {
  std::mt19937 random(key.submap + 31 * round);
  for (const int i : key.group) random.seed(random() + static_cast<uint32_t>(i));
  BlockGroups group(layers().size());
  for (int local = static_cast<int>(random() % 16); local < 64;
       local += 1 + static_cast<int>(random() % 32)) {
    const BlockIndex block = 4 * key.group + BlockIndex(local % 4, local / 4 % 4, local / 16);
    const int state = static_cast<int>(random() % 512);
    for (size_t i = 0; i < group.size(); ++i) {
      group[i].blocks.push_back(block);
      group[i].states.push_back(state);
      for (size_t byte = 0; byte < layers()[i].bytesPerBlock(kBlockSize); byte += 4) {
        const uint32_t word = static_cast<uint32_t>(random());
        group[i].voxels.append(reinterpret_cast<const char*>(&word), 4);
      }
    }
  }
  return group;
}

GroupKey keyNumber(int i) { return {static_cast<uint32_t>(i % 3), {i % 11 - 5, i / 11 % 13, -i / 143}}; }

void expectSame(const BlockGroups& a, const BlockGroups& b) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].blocks, b[i].blocks);
    EXPECT_EQ(a[i].states, b[i].states);
    EXPECT_TRUE(a[i].voxels == b[i].voxels);
  }
}

SubmapParameters smallMemory(const std::string& store = "") {
  SubmapParameters parameters;
  parameters.memory_mib = 1;
  parameters.store = store;
  return parameters;
}

// Waits until the thread has done what there is to do.
void settle(const BlockStore& store) {
  for (int i = 0; i < 6000; ++i) {
    const StoreUsage usage = store.usage();
    if (usage.waiting_bytes == 0 && usage.memory_bytes <= size_t{1} << 20) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  FAIL() << "the store does not settle: " << store.usage().problem;
}

// Puts, overwrites and takes at random, and compares all with what it should be.
void expectToKeepAll(BlockStore& store, int groups) {
  std::map<GroupKey, uint32_t> rounds;
  std::mt19937 random(5);
  for (int i = 0; i < 3 * groups; ++i) {
    const GroupKey key = keyNumber(static_cast<int>(random() % static_cast<uint32_t>(groups)));
    const auto known = rounds.find(key);
    if (known != rounds.end() && random() % 3 == 0) {
      expectSame(*store.take(key), groupOf(key, known->second));
      rounds.erase(known);
    } else {
      rounds[key] = static_cast<uint32_t>(i);
      store.put(key, groupOf(key, static_cast<uint32_t>(i)));
    }
  }
  settle(store);
  EXPECT_GT(store.usage().groups_on_disk, 0u);
  EXPECT_EQ(store.usage().groups_on_disk + store.usage().groups_in_memory, rounds.size());
  std::vector<GroupKey> keys;
  for (const auto& [key, round] : rounds) keys.push_back(key);
  store.readAhead(keys);
  for (const auto& [key, round] : rounds) expectSame(*store.take(key), groupOf(key, round));
  const StoreUsage usage = store.usage();
  EXPECT_EQ(usage.groups_in_memory + usage.groups_on_disk, 0u);
  EXPECT_EQ(usage.memory_bytes + usage.disk_bytes + usage.waiting_bytes, 0u);
  EXPECT_EQ(usage.problem, "");
}

// DEPTH_FUSION_GROUPS in the environment says how many, in place of 1,500: of 200,000, more than a million
// blocks are compared.
TEST(BlockStore, KeepsWhatGoesThroughMemoryAndFile) {
  const char* groups = std::getenv("DEPTH_FUSION_GROUPS");
  const TemporaryFolder folder;
  {
    BlockStore store(smallMemory(folder / ""), layers(), kBlockSize);
    expectToKeepAll(store, groups == nullptr ? 1500 : std::stoi(groups));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder / "")) << "the file is gone with the store";
}

TEST(BlockStore, KeepsWhatGoesThroughAServer) {
  if (PostgresServer::programs().empty()) GTEST_SKIP() << "no PostgreSQL server here";
  PostgresServer server;
  BlockStore store(smallMemory(server.uri("scratch")), layers(), kBlockSize);
  expectToKeepAll(store, 150);
}

// Mapping goes on in memory while the server is away; what was stored comes back with it.
TEST(BlockStore, OutlastsAServerThatIsAway) {
  if (PostgresServer::programs().empty()) GTEST_SKIP() << "no PostgreSQL server here";
  PostgresServer server;
  BlockStore store(smallMemory(server.uri("scratch")), layers(), kBlockSize);
  for (int i = 0; i < 200; ++i) store.put(keyNumber(i), groupOf(keyNumber(i)));
  settle(store);
  server.stop();
  for (int i = 200; i < 400; ++i) store.put(keyNumber(i), groupOf(keyNumber(i)));
  for (int i = 0; i < 6000 && store.hasRoom(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(store.hasRoom());
  EXPECT_NE(store.usage().problem.find("#scratch"), std::string::npos) << store.usage().problem;
  EXPECT_THROW(store.take(keyNumber(0)), Error) << "it is on the server";
  server.start();
  settle(store);
  EXPECT_EQ(store.usage().problem, "");
  EXPECT_TRUE(store.hasRoom());
  for (int i = 0; i < 400; ++i) expectSame(*store.take(keyNumber(i)), groupOf(keyNumber(i)));
}

// A tenth of a second for each transaction is no failure.
TEST(BlockStore, KeepsWhatGoesThroughASlowServer) {
  if (PostgresServer::programs().empty()) GTEST_SKIP() << "no PostgreSQL server here";
  PostgresServer server;
  const std::string uri = server.uri("scratch");
  const std::string options = "options=-c%20commit_delay%3D100000%20-c%20commit_siblings%3D0";
  const size_t name = uri.find('#');
  const std::string slow =
      uri.substr(0, name) + (uri.find('?') < name ? "&" : "?") + options + uri.substr(name);
  BlockStore store(smallMemory(slow), layers(), kBlockSize);
  expectToKeepAll(store, 150);
}

TEST(BlockStore, SaysThatTheDiskIsFullAndCatchesUp) {
  const TemporaryFolder folder;
  BlockStore store(smallMemory(folder / ""), layers(), kBlockSize);
  {
    const FullDisk full;
    for (int i = 0; i < 400; ++i) store.put(keyNumber(i), groupOf(keyNumber(i)));
    for (int i = 0; i < 6000 && store.hasRoom(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(store.hasRoom());
    EXPECT_NE(store.usage().problem, "");
  }
  settle(store);
  EXPECT_EQ(store.usage().problem, "");
  for (int i = 0; i < 400; ++i) expectSame(*store.take(keyNumber(i)), groupOf(keyNumber(i)));
}

TEST(BlockStore, KeepsToItsLimitOfTheDisk) {
  const TemporaryFolder folder;
  SubmapParameters parameters = smallMemory(folder / "");
  parameters.disk_mib = 4;
  BlockStore store(parameters, layers(), kBlockSize);
  for (int i = 0; i < 2000; ++i) {
    if (!store.hasRoom()) break;
    store.put(keyNumber(i), groupOf(keyNumber(i)));
  }
  for (int i = 0; i < 6000 && store.hasRoom(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_NE(store.usage().problem.find("submaps/disk_mib"), std::string::npos) << store.usage().problem;
  EXPECT_LE(store.usage().disk_bytes, size_t{4} << 20);
}

TEST(BlockStore, RefusesAPlaceThatCannotBeWrittenOrHoldsAMap) {
  const TemporaryFolder folder;
  BlockStore store(smallMemory(folder / "none"), layers(), kBlockSize);
  for (int i = 0; i < 200; ++i) store.put(keyNumber(i), groupOf(keyNumber(i)));
  for (int i = 0; i < 6000 && store.usage().problem.empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_NE(store.usage().problem.find("submaps/store"), std::string::npos) << store.usage().problem;
}

TEST(BlockStore, ASnapshotStaysAsItWas) {
  const TemporaryFolder folder;
  BlockStore store(smallMemory(folder / ""), layers(), kBlockSize);
  std::vector<GroupKey> keys;
  for (int i = 0; i < 300; ++i) {
    keys.push_back(keyNumber(i));
    store.put(keys.back(), groupOf(keys.back()));
  }
  settle(store);
  std::sort(keys.begin(), keys.end());
  const auto snapshot = store.snapshot(keys);
  for (int i = 0; i < 300; ++i) {
    store.take(keyNumber(i));
    store.put(keyNumber(i), groupOf(keyNumber(i), 9));
  }
  settle(store);
  for (const GroupKey& key : keys) {
    expectSame(snapshot->group(key), groupOf(key));
    expectSame(*store.take(key), groupOf(key, 9));
  }
}

}  // namespace
}  // namespace depth_fusion
