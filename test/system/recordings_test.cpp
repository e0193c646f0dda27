// The real recordings, fused by the app: tracking, its accuracy, and memory.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "depth_fusion/recording/trajectory_file.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "support/apps.h"
#include "support/real_data.h"
#include "tools/evaluation/trajectory_error.h"

namespace depth_fusion {
namespace {

constexpr double kMostTrackingBytes = 0.5e9;
constexpr double kMostBytes = 0.6e9;
constexpr double kLeastArea_m2 = 10.0;

struct RecordingCase {
  std::string name;
  size_t frames;
  double max_ate_m;
  std::vector<std::string> options;  // of reconstruct
};

void PrintTo(const RecordingCase& recording, std::ostream* stream) { *stream << recording.name; }

double areaOf(const TriangleMesh& mesh) {
  const auto position = [&](uint32_t vertex) { return mesh.vertices[vertex].position_W.cast<double>(); };
  double area_m2 = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area_m2 += 0.5 * (position(b) - position(a)).cross(position(c) - position(a)).norm();
  }
  return area_m2;
}

class Recordings : public testing::TestWithParam<RecordingCase> {};

TEST_P(Recordings, no_frame_is_lost_and_memory_stays_in_bounds) {
  const RecordingCase& recording = GetParam();
  const std::string input = realDataFolder(recording.name);
  if (!std::filesystem::exists(input)) GTEST_SKIP() << input << " is not there";
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"--input", input, "--output", folder.path()};
  arguments.insert(arguments.end(), recording.options.begin(), recording.options.end());
  const AppRun run = runApp("reconstruct", arguments);
  ASSERT_EQ(run.status, 0) << run.errors;

  const nlohmann::json report = readReport(folder.path());
  EXPECT_EQ(report["frames"]["read"], recording.frames);
  EXPECT_EQ(report["frames"]["lost"], 0);
  EXPECT_LE(report["tracking_peak_rss_bytes"].get<double>(), kMostTrackingBytes);
  EXPECT_LE(report["peak_rss_bytes"].get<double>(), kMostBytes);

  const TrajectoryError error =
      compareTrajectories(readTrajectory(folder / "trajectory.txt"), readPoses(input));
  EXPECT_GE(error.pairs.size(), recording.frames - 5);
  EXPECT_LE(error.ate_m.rmse, recording.max_ate_m);

  const double area_m2 = areaOf(readPly(folder / "mesh.ply"));
  EXPECT_GE(area_m2, kLeastArea_m2);
  std::printf("%s: ATE %.1f mm, mesh %.2f m^2, peak RSS %.0f MB, %.0f MB while tracking, %.1f ms a frame\n",
              recording.name.c_str(), 1000.0 * error.ate_m.rmse, area_m2,
              report["peak_rss_bytes"].get<double>() / 1e6,
              report["tracking_peak_rss_bytes"].get<double>() / 1e6,
              report["frame_ms"]["median"].get<double>());
}

const std::vector<std::string> kKinect = {"--params", "cfg/kinect_v1.yaml"};
const std::vector<std::string> kCalibratedKinect = {"--params", "cfg/kinect_v1.yaml", "--camera",
                                                    "cfg/cameras/tum_freiburg1.yaml"};

INSTANTIATE_TEST_SUITE_P(All, Recordings,
                         testing::Values(RecordingCase{"tum_fr1_xyz", 500, 0.011, kCalibratedKinect},
                                         RecordingCase{"redkitchen", 300, 0.035, kKinect}));

}  // namespace
}  // namespace depth_fusion
