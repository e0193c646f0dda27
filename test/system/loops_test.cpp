// Loops of a recording, by `reconstruct`: what they are closed by, and the second pass.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "common/io/text_file.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "support/apps.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

// Has a recording go on with its frames in reverse.
void goBack(const std::string& folder) {
  for (const char* list : {"depth.txt", "rgb.txt", "groundtruth.txt"}) {
    std::istringstream all(fileBytes(folder + "/" + list));
    std::vector<std::pair<double, std::string>> rows;
    for (std::string line; std::getline(all, line);) {
      if (line[0] != '#') rows.emplace_back(std::stod(line), line.substr(line.find(' ')));
    }
    const double turn_s = 2.0 * rows.back().first + 0.125;
    std::ofstream more(folder + "/" + list, std::ios::app);
    more << std::fixed << std::setprecision(6);
    for (auto row = rows.rbegin(); row != rows.rend(); ++row)
      more << turn_s - row->first << row->second << "\n";
  }
}

// A way in the room, and back; every loop is applied, however little it moves.
class Loops : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    writeText(*folder_ / "loops.yaml",
              "loops: {min_way_m: 0.5, agreeing_loops: 2, least_move_m: 0.0}\nmap: {voxel_size_m: 0.01}\n");
    runApp("simulate", {"--output", *folder_ / "room", "--fps", "8", "--frames", "40"});
    goBack(*folder_ / "room");
    both_passes_ = reconstruct("both", {"--map", *folder_ / "room.map"});
    one_pass_ = reconstruct("one", {"--single-pass"});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static AppRun reconstruct(const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"--input",         *folder_ / "room", "--output",
                                          *folder_ / output, "--params",        *folder_ / "loops.yaml"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runApp("reconstruct", arguments);
  }
  static nlohmann::json evaluate(const std::string& output) {
    const std::string room = *folder_ / "room", results = *folder_ / output;
    const AppRun run =
        runApp("evaluate", {"--groundtruth", room + "/groundtruth.txt", "--json", "--trajectory",
                            results + "/trajectory.txt", "--mesh", results + "/mesh.ply", "--scene", room});
    EXPECT_EQ(run.status, 0) << run.errors;
    return nlohmann::json::parse(run.output);
  }

  inline static std::unique_ptr<TemporaryFolder> folder_;
  inline static AppRun both_passes_, one_pass_;
};

TEST_F(Loops, AreClosedAndSaid) {
  ASSERT_EQ(both_passes_.status, 0) << both_passes_.errors;
  EXPECT_NE(both_passes_.output.find("the frames are fused once more"), std::string::npos)
      << both_passes_.output;
  EXPECT_GT(readReport(*folder_ / "both")["loops"]["closed"], 0);
  EXPECT_GT(readReport(*folder_ / "both")["loops"]["moved_m"], 0.0);
  EXPECT_NE(fileBytes(*folder_ / "both/loops.csv").find(",closed,"), std::string::npos);
}

TEST_F(Loops, AreNotSoughtInASinglePass) {
  ASSERT_EQ(one_pass_.status, 0) << one_pass_.errors;
  EXPECT_EQ(readReport(*folder_ / "one")["loops"]["closed"], 0);
  EXPECT_FALSE(fs::exists(*folder_ / "one/loops.csv"));
  const std::string trajectory = fileBytes(*folder_ / "one/trajectory.txt");
  EXPECT_TRUE(trajectory == fileBytes(*folder_ / "both/trajectory_without_loops.txt"));
  EXPECT_FALSE(trajectory == fileBytes(*folder_ / "both/trajectory.txt"));
}

TEST_F(Loops, LeaveTrajectoryAndMeshOfOnePiece) {
  for (const char* output : {"one", "both"}) {
    const nlohmann::json errors = evaluate(output);
    EXPECT_EQ(errors["trajectory"]["compared_poses"], 80) << output;
    EXPECT_LE(errors["trajectory"]["ate_m"]["rmse"], 0.01) << output;
    EXPECT_LE(errors["mesh"]["surface_m"]["mean"], 0.008) << output;
  }
}

// The map of the second pass has keyframes where they are now.
TEST_F(Loops, LeaveAMapThatIsGoneOnWith) {
  const AppRun run =
      reconstruct("continued", {"--continue", *folder_ / "room.map", "--map", *folder_ / "2.map"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("frame 1: found in the map"), std::string::npos) << run.output;
}

}  // namespace
}  // namespace depth_fusion
