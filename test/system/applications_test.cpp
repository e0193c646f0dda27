// The apps as a user runs them, one after the other.
#include <gtest/gtest.h>

#include <filesystem>

#include "common/io/text_file.h"
#include "depth_fusion/recording/trajectory_file.h"
#include "recording/timed_files.h"
#include "support/apps.h"
#include "support/html_check.h"

namespace depth_fusion {
namespace {

using Json = nlohmann::json;

constexpr char kFrames[] = "10";

// Simulates and reconstructs once for all tests; `room` is a folder in the TUM layout.
class Applications : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    simulated_ = runApp("simulate", {"--output", room(), "--frames", kFrames});
    reconstructed_ = runApp("reconstruct", {"--input", room(), "--output", out()});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string room() { return *folder_ / "room"; }
  static std::string out() { return *folder_ / "out"; }
  static std::string inFolder(const std::string& name) { return *folder_ / name; }
  // `evaluate` with the exact poses of the room.
  static Json evaluate(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--groundtruth", room() + "/groundtruth.txt", "--json"});
    const AppRun run = runApp("evaluate", arguments);
    EXPECT_EQ(run.status, 0) << run.errors;
    return Json::parse(run.output);
  }
  // The mesh is placed by the first pose: the way of a few frames is too straight for an alignment.
  static void expectAccurate(const std::string& output) {
    const Json trajectory = evaluate({"--trajectory", output + "/trajectory.txt"})["trajectory"];
    EXPECT_EQ(trajectory["compared_poses"], std::stoi(kFrames));
    EXPECT_LE(trajectory["ate_m"]["rmse"], 0.005);
    const Json mesh = evaluate({"--mesh", output + "/mesh.ply", "--scene", room()})["mesh"];
    EXPECT_LE(mesh["surface_m"]["mean"], 0.005);
    EXPECT_GE(mesh["area_m2"], 4.0);
  }

  inline static std::unique_ptr<TemporaryFolder> folder_;
  inline static AppRun simulated_, reconstructed_;
};

void expectStatistics(const Json& statistics, const std::string& what) {
  ASSERT_TRUE(statistics.contains("median") && statistics.contains("p95")) << what;
  EXPECT_GT(statistics["median"], 0.0) << what;
  EXPECT_GE(statistics["p95"], statistics["median"]) << what;
}

TEST_F(Applications, simulate_and_reconstruct_say_what_they_do) {
  EXPECT_EQ(simulated_.status, 0);
  EXPECT_EQ(simulated_.errors, "");
  EXPECT_EQ(reconstructed_.status, 0);
  EXPECT_EQ(reconstructed_.errors, "");
  for (const std::string text :
       {"device: ", "input: TUM layout", "frame 10/10", " fps", "tracking", "mesh.ply"}) {
    EXPECT_NE(reconstructed_.output.find(text), std::string::npos) << "'" << text << "' is missing";
  }
}

TEST_F(Applications, result_is_accurate) { expectAccurate(out()); }

TEST_F(Applications, trajectory_has_a_line_a_frame_with_the_depth_stamps) {
  const std::vector<TimedFile> depth_files = readTimedFiles(room() + "/depth.txt");
  const Trajectory trajectory = readTrajectory(out() + "/trajectory.txt");
  ASSERT_EQ(trajectory.size(), depth_files.size());
  for (size_t i = 0; i < trajectory.size(); ++i) EXPECT_EQ(trajectory[i].stamp_s, depth_files[i].stamp_s);
  EXPECT_TRUE(trajectory.front().T_W_D.isApprox(Pose::Identity()));
}

TEST_F(Applications, report_counts_frames_and_names_the_device) {
  const Json report = readReport(out());
  EXPECT_NE(report["device"].get<std::string>().find("self-test passed"), std::string::npos);
  EXPECT_EQ(report["frames"]["read"], std::stoi(kFrames));
  EXPECT_EQ(report["frames"]["tracked"], std::stoi(kFrames));
  EXPECT_EQ(report["frames"]["lost"], 0);
  EXPECT_FLOAT_EQ(report["parameters"]["map/voxel_size_m"], 0.005f);
}

TEST_F(Applications, report_has_the_times_of_every_stage) {
  const Json report = readReport(out());
  expectStatistics(report["frame_ms"], "frame");
  for (const std::string stage : {"recording/read", "preprocessing", "icp_tracking", "tsdf_fusion/integrate",
                                  "model_view/raycast", "surface_mesh"}) {
    ASSERT_TRUE(report["stage_ms"].contains(stage)) << stage;
    expectStatistics(report["stage_ms"][stage], stage);
  }
}

TEST_F(Applications, report_has_the_memory_of_the_map) {
  const Json report = readReport(out());
  const uint64_t blocks = report["map"]["blocks"];
  const uint64_t n = report["parameters"]["map/blocks_per_axis"];
  const uint64_t m = report["parameters"]["map/block_size"];
  EXPECT_GT(blocks, 1000u);
  EXPECT_EQ(report["map"]["bytes"].get<uint64_t>(), 2 * blocks * m * m * m + 4 * n * n * n);
  EXPECT_GE(report["map"]["pool_bytes"], report["map"]["bytes"]);
  EXPECT_GT(report["peak_rss_bytes"], report["map"]["bytes"]);
  EXPECT_LT(report["peak_rss_bytes"].get<double>(), 0.6e9);
}

TEST_F(Applications, bag_gives_the_same_as_the_folder) {
  const std::string bag = inFolder("room.bag");
  ASSERT_EQ(runApp("simulate", {"--output", bag, "--frames", kFrames}).status, 0);
  const AppRun run = runApp("reconstruct", {"--input", bag, "--output", inFolder("bag_out")});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("input: bag"), std::string::npos);
  expectAccurate(inFolder("bag_out"));
}

TEST_F(Applications, given_poses_take_the_place_of_tracking) {
  const std::string output = inFolder("given_out");
  const AppRun run = runApp("reconstruct", {"--input", room(), "--output", output, "--trajectory",
                                            room() + "/groundtruth.txt", "--max-frames", "4"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const Trajectory truth = readTrajectory(room() + "/groundtruth.txt");
  const Trajectory used = readTrajectory(output + "/trajectory.txt");
  ASSERT_EQ(used.size(), 4u);
  for (size_t i = 0; i < used.size(); ++i) EXPECT_TRUE(used[i].T_W_D.isApprox(truth[i].T_W_D, 1e-6));
  EXPECT_FALSE(readReport(output)["stage_ms"].contains("icp_tracking"));
}

TEST_F(Applications, options_reach_the_parameters_and_win_over_the_file) {
  writeText(inFolder("parameters.yaml"),
            "map: {voxel_size_m: 0.02, pool_mib: 64}\ntsdf_fusion: {max_weight: 100}\n");
  const std::string output = inFolder("options_out");
  const AppRun run = runApp("reconstruct", {"--voxel-size",      "0.01",
                                            "--blocks-per-axis", "64",
                                            "--block-size",      "16",
                                            "--max-range",       "3",
                                            "--intrinsics",      "525,525,319.5,239.5",
                                            "--params",          inFolder("parameters.yaml"),
                                            "--max-frames",      "3",
                                            "--device",          "0",
                                            "--input",           room(),
                                            "--output",          output});
  ASSERT_EQ(run.status, 0) << run.errors;
  const Json parameters = readReport(output)["parameters"];
  EXPECT_FLOAT_EQ(parameters["map/voxel_size_m"], 0.01f);
  EXPECT_FLOAT_EQ(parameters["map/truncation_m"], 0.04f);
  EXPECT_EQ(parameters["map/blocks_per_axis"], 64);
  EXPECT_EQ(parameters["map/block_size"], 16);
  EXPECT_EQ(parameters["map/pool_mib"], 64);
  EXPECT_EQ(parameters["tsdf_fusion/max_weight"], 100.0);
  EXPECT_EQ(parameters["preprocessing/max_range_m"], 3.0);
}

// Another place after three frames: the map of those begins anew, and their poses are of no world any more.
TEST_F(Applications, poses_of_a_map_that_is_gone_are_left_out) {
  const std::string another = inFolder("another"), both = inFolder("both");
  ASSERT_EQ(runApp("simulate", {"--output", another, "--scene", "cylinder", "--frames", "16"}).status, 0);
  std::filesystem::create_directory(both);
  std::filesystem::copy(room() + "/camera.yaml", both + "/camera.yaml");
  for (const std::string list : {"/depth.txt", "/rgb.txt"}) {
    std::vector<TimedFile> files = readTimedFiles(room() + list);
    files.resize(3);
    for (const TimedFile& file : readTimedFiles(another + list))
      files.push_back({file.stamp_s + 10.0, file.path});
    std::string lines;
    for (const TimedFile& file : files) {
      lines += std::to_string(file.stamp_s) + " " +
               std::filesystem::path(file.path).lexically_relative(both).string() + "\n";
    }
    writeText(both + list, lines);
  }
  writeText(inFolder("young.yaml"), "relocalisation: {give_up_after_frames: 4}\n");
  const AppRun run = runApp("reconstruct", {"--input", both, "--output", inFolder("of_both"), "--no-mesh",
                                            "--params", inFolder("young.yaml")});
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("another world; 3 of them count as lost"), std::string::npos) << run.output;
  const Trajectory trajectory = readTrajectory(inFolder("of_both") + "/trajectory.txt");
  const Json frames = readReport(inFolder("of_both"))["frames"];
  ASSERT_EQ(trajectory.size(), frames["tracked"].get<size_t>());
  EXPECT_EQ(trajectory.size() + frames["lost"].get<size_t>(), 19u);
  EXPECT_EQ(trajectory.size(), 12u);
  EXPECT_GT(trajectory.front().stamp_s, 10.0);
}

TEST_F(Applications, render_draws_the_mesh) {
  const AppRun run = runApp("render", {"--mesh", out() + "/mesh.ply", "--output", inFolder("mesh.png"),
                                       "--width", "320", "--height", "240"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const std::string picture = fileBytes(inFolder("mesh.png"));
  EXPECT_EQ(picture.substr(1, 3), "PNG");
  EXPECT_GT(picture.size(), 10000u);
}

TEST_F(Applications, color_is_fused_drawn_and_reported) {
  const std::string output = inFolder("color_out");
  const AppRun run =
      runApp("reconstruct", {"--input", room(), "--output", output, "--color", "--voxel-size", "0.01"});
  ASSERT_EQ(run.status, 0) << run.errors;
  const Json report = readReport(output);
  EXPECT_EQ(report["frames"]["colored"], std::stoi(kFrames));
  EXPECT_EQ(report["map"]["color_bytes"].get<uint64_t>(), report["map"]["blocks"].get<uint64_t>() * 512 * 4);
  EXPECT_EQ(readReport(out())["map"]["color_bytes"], 0);
  EXPECT_NE(fileBytes(output + "/mesh.ply").substr(0, 400).find("property uchar red"), std::string::npos);
  const auto picture = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--mesh", output + "/mesh.ply", "--output", inFolder("color.png"),
                                       "--width", "160", "--height", "120"});
    EXPECT_EQ(runApp("render", arguments).status, 0);
    return fileBytes(inFolder("color.png"));
  };
  EXPECT_NE(picture({}), picture({"--shaded"}));
}

TEST_F(Applications, page_shows_model_way_and_errors) {
  const std::string output = inFolder("page_out");
  const AppRun run = runApp(
      "reconstruct", {"--input", room(), "--output", output, "--color", "--voxel-size", "0.02", "--report"});
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("report.html"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out() + "/report.html"));
  const std::string page = fileBytes(output + "/report.html");
  expectWellFormed(page);
  expectAlone(page);
  for (const std::string text : {"<h1>room</h1>", "All 10 frames were tracked", "id=\"plan\"", "id=\"model\"",
                                 "id=\"errors\"", "The error of the surface", "true way", "icp_tracking"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_LT(page.size(), 8u << 20);
}

TEST_F(Applications, help_names_every_option) {
  const AppRun run = runApp("reconstruct", {"--help"});
  EXPECT_EQ(run.status, 0);
  for (const std::string option :
       {"--input", "--output", "--voxel-size", "--blocks-per-axis", "--block-size", "--truncation",
        "--max-range", "--intrinsics", "--params", "--trajectory", "--max-frames", "--device", "--color"}) {
    EXPECT_NE(run.output.find(option + " "), std::string::npos) << option;
  }
}

TEST_F(Applications, devices_are_listed) {
  const AppRun run = runApp("reconstruct", {"--device", "list"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.output.find("[0] "), 0u) << run.output;
}

}  // namespace
}  // namespace depth_fusion
