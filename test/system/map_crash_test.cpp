// A process that saves a map is killed at random moments: the map is then as at the last save that ended.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

#include "depth_fusion/submaps/map_check.h"
#include "support/stored_maps.h"
#include "support/temporary_folder.h"
#include "support/test_compute.h"

namespace depth_fusion {
namespace {

constexpr char kSaverPath[] = "DEPTH_FUSION_SAVER_PATH";
constexpr int kAnswers = 3;  // the file that the saver answers through

// Goes on with the map that is there, if there is one, and saves it over and over, as another one each time.
// Writes the revision of each save that ended.
void saveForEver(const std::string& path) {
  BlockMap map(compute(), smallMap());
  MapSaver saver(path);
  if (const std::unique_ptr<Database> stored = openStoredMap(path)) adopt(saver, map, loadMap(*stored, map));
  ChangingMap changing(compute(), map);
  for (uint32_t i = 0;; ++i) {
    changing.show(sphere({0.01 * (i % 4), 0.0, 0.0}, 0.12 + 0.01 * (i % 7)));
    save(saver, map, {someKeyframe(i)});
    const uint64_t revision = describeMap(*openDatabase(path, DatabaseAccess::kRead)).revision;
    if (write(kAnswers, &revision, sizeof(revision)) != sizeof(revision)) return;
  }
}

// Runs this program as a saver; kills it some time after its first save.
uint64_t killASaver(const std::string& path, std::chrono::microseconds after) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t saver = fork();
  if (saver == 0) {
    dup2(ends[1], kAnswers);
    setenv(kSaverPath, path.c_str(), 1);
    execl("/proc/self/exe", "saver", "--gtest_filter=Saver.*", "--gtest_also_run_disabled_tests",
          "--gtest_brief=1", nullptr);
    _exit(1);
  }
  close(ends[1]);
  uint64_t revision = 0, last = 0;
  EXPECT_EQ(read(ends[0], &revision, sizeof(revision)), static_cast<ssize_t>(sizeof(revision)));
  std::this_thread::sleep_for(after);
  kill(saver, SIGKILL);
  for (last = revision; read(ends[0], &revision, sizeof(revision)) == sizeof(revision);) last = revision;
  close(ends[0]);
  waitpid(saver, nullptr, 0);
  return last;
}

// DEPTH_FUSION_KILLS in the environment says how many, in place of 20.
TEST(MapCrash, TheFileOpensWithAllUpToTheLastSave) {
  const char* kills = std::getenv("DEPTH_FUSION_KILLS");
  const TemporaryFolder folder;
  const std::string path = folder / "ball.map";
  std::mt19937 random(1);
  for (int i = 0; i < (kills == nullptr ? 20 : std::atoi(kills)); ++i) {
    const uint64_t saved = killASaver(path, std::chrono::microseconds(random() % 60000));
    ASSERT_GT(saved, 0u);
    const auto database = openDatabase(path, DatabaseAccess::kRead);
    const MapCheck found = checkMap(*database);
    ASSERT_TRUE(found.problems.empty()) << found.problems.front();
    EXPECT_GE(found.description.revision, saved);
    BlockMap map(compute(), smallMap());
    EXPECT_EQ(loadMap(*database, map).keyframes.size(), 1u);
  }
}

TEST(Saver, DISABLED_SavesForEver) { saveForEver(std::getenv(kSaverPath)); }

}  // namespace
}  // namespace depth_fusion
