#include "tools/report/run_report.h"

#include <gtest/gtest.h>

#include "support/html_check.h"

namespace depth_fusion {
namespace {

RgbdFrame frameAt(double stamp_s) {
  RgbdFrame frame;
  frame.stamp_s = stamp_s;
  frame.depth = cv::Mat(48, 64, CV_16UC1, cv::Scalar(1500));
  frame.depth_unit_m = 0.001;
  frame.color = cv::Mat(48, 64, CV_8UC3, cv::Scalar(20, 120, 220));
  return frame;
}

TrackingResult trackedAs(TrackingStatus status, const std::string& reason = "") {
  TrackingResult tracking;
  tracking.status = status;
  tracking.reason = reason;
  tracking.prior = "texture";
  tracking.explained = 0.9;
  return tracking;
}

// A floor of two by two metres, 1 m below W, in steps of 0.1 m.
TriangleMesh floorMesh() {
  TriangleMesh mesh;
  constexpr uint32_t kEdge = 21;
  for (uint32_t i = 0; i < kEdge * kEdge; ++i) {
    const float x = 0.1f * static_cast<float>(i % kEdge), z = 0.1f * static_cast<float>(i / kEdge);
    mesh.vertices.push_back({{x - 1.0f, 1.0f, z}, {0.0f, -1.0f, 0.0f}});
    mesh.colors.push_back({200, static_cast<uint8_t>(i % 250), 30});
  }
  for (uint32_t i = 0; i + kEdge + 1 < kEdge * kEdge; ++i) {
    if (i % kEdge == kEdge - 1) continue;
    mesh.triangles.push_back({i, i + 1, i + kEdge});
    mesh.triangles.push_back({i + 1, i + kEdge + 1, i + kEdge});
  }
  return mesh;
}

// Of 100 frames the 41st to 43rd are lost.
RunReport someReport() {
  RunReport report;
  report.name = "kitchen <b> & \"co\"";
  report.input = "/data/<script>alert(1)</script>";
  report.device = "a device of 'tests'";
  report.viewer_command = "scripts/run view out";
  for (int i = 0; i < 100; ++i) {
    const bool lost = i >= 40 && i < 43;
    report.record.note(
        frameAt(0.1 * i),
        lost ? trackedAs(TrackingStatus::kLost, "3 < 5 inliers") : trackedAs(TrackingStatus::kTracking),
        1000000);
    if (lost) continue;
    StampedPose pose;
    pose.stamp_s = 0.1 * i;
    pose.T_W_D.translation() << 0.01 * i - 0.5, 0.0, 1.0;
    report.trajectory.push_back(pose);
  }
  report.mesh = floorMesh();
  report.wants_color = true;
  report.colored = 97;
  report.stages_ms["frame"] = std::vector<double>(100, 12.25);
  report.stages_ms["icp_tracking"] = std::vector<double>(100, 4.5);
  report.map_bytes = 34e6;
  report.pool_blocks = 10;
  report.pool_capacity = 100;
  report.parameters = {{"map/voxel_size_m", "0.004", "0.005", "edge of a voxel, metres"},
                       {"map/block_size", "8", "8", "voxels an edge of a block"}};
  return report;
}

void expectSaid(const std::string& page, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) EXPECT_NE(page.find(text), std::string::npos) << text;
}

TEST(RunReport, IsWellFormedAndAlone) {
  const std::string page = pageOf(someReport());
  expectWellFormed(page);
  expectAlone(page);
}

TEST(RunReport, EscapesWhatOthersName) {
  const std::string page = pageOf(someReport());
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(page.find("kitchen <b>"), std::string::npos);
  expectSaid(page, {"kitchen &lt;b&gt; &amp; &quot;co&quot;", "3 &lt; 5 inliers", "&lt;script&gt;alert(1)"});
}

TEST(RunReport, SaysWhatHappened) {
  expectSaid(
      pageOf(someReport()),
      {"3 of 100 frames were lost", "97 of 100", "<td class=\"number\">41</td><td class=\"number\">3</td>",
       "Frame 41, 4.0 s: lost", "Tracking was lost 1 time", "12.2 ms", "icp_tracking", "34 MB", "10 of 100",
       "scripts/run view out", "a device of &#39;tests&#39;", "0.004 <span class=\"soft\">(usually 0.005)",
       "id=\"model\" data-vertices=\"441\" data-triangles=\"800\" data-colored=\"1\""});
}

TEST(RunReport, SaysThatAllIsWell) {
  RunReport report = someReport();
  report.record = {};
  for (int i = 0; i < 10; ++i) report.record.note(frameAt(0.1 * i), trackedAs(TrackingStatus::kTracking), 1);
  const std::string page = pageOf(report);
  expectSaid(page, {"All 10 frames were tracked", "Nothing of this run is poor", "No frame went badly"});
}

TEST(RunReport, NeedsNoMesh) {
  RunReport report = someReport();
  report.mesh = {};
  const std::string page = pageOf(report);
  expectWellFormed(page);
  EXPECT_EQ(page.find("id=\"canvas\""), std::string::npos);
  EXPECT_EQ(page.find("id=\"plan\""), std::string::npos);
}

TEST(RunReport, ShowsErrorsWhereThereIsTruth) {
  RunReport report = someReport();
  EXPECT_EQ(pageOf(report).find("id=\"errors\""), std::string::npos);
  Trajectory truth = report.trajectory;
  for (size_t i = 0; i < truth.size(); ++i) truth[i].T_W_D.translation().y() += i % 2 == 0 ? 0.01 : -0.01;
  report.trajectory_error = compareTrajectories(report.trajectory, truth);
  const std::string page = pageOf(report);
  expectWellFormed(page);
  expectSaid(page, {"id=\"errors\"", "10.00 mm", "true way"});
}

TEST(RunReport, AdvisesByWhatIsPoor) {
  RunReport report = someReport();
  report.wants_color = false;
  report.unreadable = 7;
  report.map_doubt = "many frames contradict it";
  report.stages_ms["frame"] = {80.0};
  report.pool_blocks = 99;
  expectSaid(pageOf(report),
             {"<code>--color</code>", "7 frames could not be read", "The map may be wrong: many frames",
              "80 ms in the median", "<code>map/pool_mib</code>"});
}

}  // namespace
}  // namespace depth_fusion
