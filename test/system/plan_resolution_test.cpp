// The advisor's promise against what reconstruct then uses.
#include <gtest/gtest.h>

#include <cmath>

#include "common/io/text_file.h"
#include "support/apps.h"

namespace depth_fusion {
namespace {

class PlanResolution : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    ASSERT_EQ(runApp("simulate", {"--output", room(), "--frames", "12", "--fps", "6"}).status, 0);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string room() { return *folder_ / "room"; }
  static std::string inFolder(const std::string& name) { return *folder_ / name; }

  static AppRun plan(const std::string& output, const std::string& limit_mib,
                     std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--output", inFolder(output), "--limit", limit_mib, "--box", "5"});
    const AppRun run = runApp("plan_resolution", arguments);
    EXPECT_EQ(run.status, 0) << run.errors;
    EXPECT_EQ(run.errors, "");
    return run;
  }

  // Bytes that the last line but one of the output promises.
  static double promisedBytes(const AppRun& run) {
    const size_t line = run.output.find("recommended: ");
    if (line == std::string::npos) return 0.0;
    const size_t blocks = run.output.find(" blocks, ", line);
    return std::stod(run.output.substr(blocks + 9));
  }

  static nlohmann::json reconstruct(const std::string& output, std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--input", room(), "--output", inFolder(output)});
    const AppRun run = runApp("reconstruct", arguments);
    EXPECT_EQ(run.status, 0) << run.errors;
    return readReport(inFolder(output));
  }

  static void expectWithinTenPercent(double promised, double used) {
    EXPECT_GT(used, 0.0);
    EXPECT_NEAR(promised / used, 1.0, 0.1);
    std::printf("promised %.0f, used %.0f bytes: ratio %.3f\n", promised, used, promised / used);
  }

  inline static std::unique_ptr<TemporaryFolder> folder_;
};

// By counting alone.
TEST_F(PlanResolution, KeepsItsPromiseForARecordingAndItsMesh) {
  const AppRun planned = plan("plan", "12", {"--input", room(), "--voxel-size", "0.008", "--no-trial"});
  EXPECT_NE(planned.output.find("recommended: N 79, M 8, voxels of 8 mm"), std::string::npos)
      << planned.output;
  EXPECT_EQ(planned.output.find("do not fit"), std::string::npos);
  const nlohmann::json report = reconstruct("out", {"--params", inFolder("plan/map.yaml")});
  EXPECT_EQ(report["parameters"]["map/blocks_per_axis"], 79);
  EXPECT_FLOAT_EQ(report["parameters"]["map/voxel_size_m"], 0.008f);
  expectWithinTenPercent(promisedBytes(planned), report["map"]["bytes"]);

  const AppRun of_mesh =
      plan("mesh_plan", "12", {"--input", inFolder("out/mesh.ply"), "--voxel-size", "0.008"});
  expectWithinTenPercent(promisedBytes(of_mesh), report["map"]["bytes"]);
}

TEST_F(PlanResolution, KeepsItsPromiseWhereTheWishDoesNotFit) {
  const AppRun planned =
      plan("tight", "40", {"--input", room(), "--voxel-size", "0.002", "--trajectory", room()});
  EXPECT_NE(planned.output.find("the wished voxels of 2 mm do not fit"), std::string::npos) << planned.output;
  EXPECT_EQ(planned.output.find("tracking"), std::string::npos);
  const nlohmann::json report =
      reconstruct("tight_out", {"--params", inFolder("tight/map.yaml"), "--trajectory", room(), "--no-mesh"});
  EXPECT_GT(report["parameters"]["map/voxel_size_m"], 0.002);
  EXPECT_LE(report["map"]["bytes"].get<double>(), 40 << 20);
  expectWithinTenPercent(promisedBytes(planned), report["map"]["bytes"]);
}

TEST_F(PlanResolution, WritesTableAndFigure) {
  plan("table", "40", {"--input", room(), "--voxel-size", "0.02", "--max-frames", "2"});
  const std::vector<TextLine> lines = readTextLines(inFolder("table/memory.csv"));
  EXPECT_GT(lines.size(), 20u);
  const std::string picture = fileBytes(inFolder("table/memory.png"));
  EXPECT_EQ(picture.substr(1, 3), "PNG");
  EXPECT_GT(picture.size(), 5000u);
}

TEST_F(PlanResolution, SaysWhatIsWrong) {
  const auto errors = [](const std::vector<std::string>& arguments) {
    const AppRun run = runApp("plan_resolution", arguments);
    EXPECT_NE(run.status, 0);
    return run.errors;
  };
  EXPECT_NE(errors({"--input", "nowhere", "--output", inFolder("x")}).find("nowhere"), std::string::npos);
  EXPECT_NE(errors({"--input", room(), "--output", inFolder("x"), "--box", "-1"}).find("box"),
            std::string::npos);
  EXPECT_NE(errors({"--input", room(), "--output", inFolder("x"), "--max-frames", "2", "--limit", "1"})
                .find("raise --limit"),
            std::string::npos);
}

}  // namespace
}  // namespace depth_fusion
