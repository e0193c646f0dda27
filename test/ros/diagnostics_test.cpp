// Diagnostics: in every state of the sensor and of the map, what is wrong and what to do about it.
#include "support/diagnostics.h"

#include "ros/in_process/shared_map.h"
#include "support/live_graph.h"

namespace depth_fusion {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kFrame_s = 0.3;  // between frames

class DiagnosticsOf : public LiveGraph {
 protected:
  DiagnosticsOf() : diagnostics_(graph_.handle()), frame_(simulatedFrames(smallRoom(1)).front()) {}

  // Sends the same view again and again until the nodelet says so.
  DiagnosticStatus sendUntil(const std::string& nodelet,
                             const std::function<bool(const DiagnosticStatus&)>& fits) {
    DiagnosticStatus found;
    found.level = -1;
    for (double waited_s = 0.0; waited_s < kPatience_s && found.level < 0; waited_s += kFrame_s) {
      frame_.stamp_s += kFrame_s;
      camera_.publish(frame_);
      found = diagnostics_.await(nodelet, fits, kFrame_s);
    }
    EXPECT_GE(found.level, 0) << nodelet << " never said so";
    return found;
  }
  DiagnosticStatus sendUntil(const std::string& nodelet, int level, const std::string& words) {
    return sendUntil(nodelet, [&](const DiagnosticStatus& status) {
      return status.level == level && status.message.find(words) != std::string::npos;
    });
  }
  DiagnosticStatus sendUntilRunning(const std::string& nodelet) {
    return sendUntil(nodelet, [](const DiagnosticStatus& status) {
      return status.level == DiagnosticStatus::OK && status.message == "running" &&
             std::stod(valueOf(status, "frames a second")) > 0.0 && valueOf(status, "inliers") != "0";
    });
  }

  Diagnostics diagnostics_;
  RgbdFrame frame_;
};

TEST_F(DiagnosticsOf, ASensorThatIsNotThere) {
  loadTracking();
  EXPECT_TRUE(diagnostics_.says(
      "texture_odometry", DiagnosticStatus::WARN,
      "no depth image yet on " + graph_.resolve("depth/image") + "; is the sensor running"));
  EXPECT_TRUE(diagnostics_.says("icp_tracking", DiagnosticStatus::WARN, "no frames from texture_odometry"));
  EXPECT_TRUE(diagnostics_.says("tsdf_fusion", DiagnosticStatus::WARN, "no frames from icp_tracking"));
}

TEST_F(DiagnosticsOf, ASensorThatRunsAndStops) {
  loadTracking();
  const DiagnosticStatus odometry = sendUntilRunning("texture_odometry");
  const DiagnosticStatus tracking = sendUntilRunning("icp_tracking");
  const DiagnosticStatus fusion = sendUntilRunning("tsdf_fusion");
  for (const DiagnosticStatus& status : {odometry, tracking, fusion}) {
    for (const char* key : {"frames a second", "frames received", "frames processed", "queue"})
      EXPECT_NE(valueOf(status, key), "") << status.name << " " << key;
  }
  EXPECT_EQ(valueOf(tracking, "state"), "tracking");
  EXPECT_GT(std::stoi(valueOf(tracking, "inliers")), 1000);
  EXPECT_GT(std::stoi(valueOf(fusion, "blocks")), 100);
  EXPECT_GT(std::stod(valueOf(fusion, "pool used")), 0.0);
  for (const DiagnosticStatus& status : {tracking, fusion})
    EXPECT_NE(valueOf(status, "device"), "") << status.name;
  EXPECT_NE(valueOf(odometry, "texture_odometry ms").find("median"), std::string::npos);
  EXPECT_NE(valueOf(tracking, "icp_tracking ms").find("median"), std::string::npos);
  EXPECT_NE(valueOf(fusion, "tsdf_fusion/integrate ms").find("median"), std::string::npos);
  EXPECT_TRUE(diagnostics_.says("texture_odometry", DiagnosticStatus::WARN, " s; is the sensor running?"));
}

TEST_F(DiagnosticsOf, ASensorThatIsLost) {
  loadTracking();
  sendUntilRunning("icp_tracking");
  frame_.depth.setTo(0);
  const DiagnosticStatus lost = sendUntil("icp_tracking", DiagnosticStatus::ERROR, "lost: ");
  EXPECT_NE(lost.message.find("; move the sensor back to where it has been"), std::string::npos);
  EXPECT_EQ(valueOf(lost, "state"), "lost");
  EXPECT_GT(std::stoi(valueOf(lost, "dropped: lost")), 0);
  setMode(SetMode::Request::PAUSED);
  EXPECT_EQ(valueOf(sendUntil("icp_tracking", DiagnosticStatus::WARN, "paused"), "state"), "paused");
}

// A bare wall without texture, along which the sensor may slide unnoticed: it is lost before it may be wrong.
TEST_F(DiagnosticsOf, ASensorThatMayBeElsewhere) {
  frame_.depth.setTo(1.0 / frame_.depth_unit_m);
  frame_.color.setTo(cv::Scalar::all(0));
  loadTracking();
  const DiagnosticStatus status =
      sendUntil("icp_tracking", DiagnosticStatus::ERROR, "the sensor may have moved by");
  EXPECT_EQ(valueOf(status, "state"), "lost");
}

TEST_F(DiagnosticsOf, ATrackerWithoutAMap) {
  ASSERT_TRUE(graph_.load("icp_tracking"));
  ASSERT_TRUE(graph_.load("texture_odometry"));
  const DiagnosticStatus alone =
      sendUntil("icp_tracking", DiagnosticStatus::ERROR, "no map to track against");
  EXPECT_EQ(alone.message.find("move the sensor"), std::string::npos);
}

TEST_F(DiagnosticsOf, APoolThatIsFull) {
  graph_.handle().setParam("map/pool_mib", 1);
  loadTracking();
  const DiagnosticStatus full = sendUntil("tsdf_fusion", DiagnosticStatus::ERROR, "the pool is full");
  EXPECT_NE(full.message.find("raise map/pool_mib or map/voxel_size_m"), std::string::npos);
  EXPECT_GT(std::stoi(valueOf(full, "blocks left out")), 0);
}

TEST_F(DiagnosticsOf, AMachineThatIsTooSlow) {
  loadTracking();
  sendUntilRunning("icp_tracking");
  const std::shared_ptr<SharedMap> map = findMap(graph_.resolve("tsdf_fusion"));
  // Fusion has to wait for the map, and tracking for fusion.
  const DiagnosticStatus slow =
      map->locked([&](FusedMap&) { return sendUntil("icp_tracking", DiagnosticStatus::WARN, "too slow: "); });
  EXPECT_NE(slow.message.find("larger map/voxel_size_m"), std::string::npos);
  EXPECT_GT(std::stoi(valueOf(slow, "dropped: too slow")), 0);
}

}  // namespace
}  // namespace depth_fusion
