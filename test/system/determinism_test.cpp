// The same input gives the same trajectory and mesh, bit for bit, on the same device.
#include <gtest/gtest.h>

#include "support/apps.h"

namespace depth_fusion {
namespace {

// One thread of PoCL takes the work-items in another order than several do; other platforms ignore the
// variable.
TEST(Determinism, app_writes_the_same_bytes_every_time) {
  const TemporaryFolder folder;
  ASSERT_EQ(runApp("simulate", {"--output", folder / "room", "--frames", "12"}).status, 0);
  const auto reconstruct = [&](const std::string& name, const std::vector<std::string>& environment) {
    const AppRun run =
        runApp("reconstruct", {"--input", folder / "room", "--output", folder / name}, environment);
    ASSERT_EQ(run.status, 0) << run.errors;
  };
  reconstruct("first", {});
  reconstruct("second", {});
  reconstruct("one_thread", {"POCL_MAX_PTHREAD_COUNT=1"});
  for (const std::string file : {"/trajectory.txt", "/mesh.ply"}) {
    const std::string bytes = fileBytes(folder / ("first" + file));
    EXPECT_GT(bytes.size(), 100u) << file;
    EXPECT_TRUE(bytes == fileBytes(folder / ("second" + file))) << file;
    EXPECT_TRUE(bytes == fileBytes(folder / ("one_thread" + file))) << file;
  }
}

}  // namespace
}  // namespace depth_fusion
