// A recording played without loss gives what the offline pipeline makes of it, bit for bit.
#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include "common/io/image_file.h"
#include "common/io/text_file.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "recording/timed_files.h"
#include "ros/bags/open_recording.h"
#include "ros/in_process/shared_map.h"
#include "support/diagnostics.h"
#include "support/map_contents.h"
#include "support/nodelet_graph.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 40;

std::string writeBag(const TemporaryFolder& folder) {
  const std::string path = folder / "room.bag";
  const auto bag = createBag(path);
  for (const RgbdFrame& frame : simulatedFrames(smallRoom(kFrames))) bag->write(frame);
  bag->finish();
  return path;
}

bool sameBits(const geometry_msgs::Pose& a, const geometry_msgs::Pose& b) {
  return a.position.x == b.position.x && a.position.y == b.position.y && a.position.z == b.position.z &&
         a.orientation.x == b.orientation.x && a.orientation.y == b.orientation.y &&
         a.orientation.z == b.orientation.z && a.orientation.w == b.orientation.w;
}

TEST(Lossless, GivesTheOfflineTrajectoryAndMap) {
  const TemporaryFolder folder;
  const std::string bag = writeBag(folder);
  ComputeContext compute;
  const auto recording = openRecording(bag, {});
  std::unique_ptr<ReconstructionPipeline> offline;
  std::vector<geometry_msgs::Pose> expected;
  while (const auto frame = recording->next()) {
    if (!offline)
      offline = std::make_unique<ReconstructionPipeline>(compute, PipelineParameters(), frame->intrinsics);
    const FrameResult result = offline->processFrame(*frame);
    ASSERT_NE(result.tracking.status, TrackingStatus::kLost);
    expected.push_back(toMessage(result.tracking.T_W_D));
  }
  ASSERT_EQ(expected.size(), size_t{kFrames});

  NodeletGraph graph("lossless");
  Listener<geometry_msgs::PoseWithCovarianceStamped> poses(graph.handle(), "icp_tracking/pose");
  Listener<MapStatus> map_status(graph.handle(), "tsdf_fusion/status");
  graph.handle().setParam("icp_tracking/level_start", false);
  graph.handle().setParam("acquisition/recording", bag);
  graph.handle().setParam("acquisition/device", "none such");  // not opened: the bag is registered
  graph.handle().setParam("acquisition/lossless", true);
  graph.handle().setParam("acquisition/rate", 100.0);
  graph.loadTracking();
  ASSERT_TRUE(graph.load("acquisition"));
  ASSERT_TRUE(map_status.awaitCount(kFrames));
  ASSERT_TRUE(poses.awaitCount(kFrames));
  EXPECT_EQ(map_status.count(), size_t{kFrames});
  for (const auto& status : map_status.all()) EXPECT_TRUE(status->fused) << status->reason;
  for (size_t i = 0; i < expected.size(); ++i)
    EXPECT_TRUE(sameBits(poses.all()[i]->pose.pose, expected[i])) << "frame " << i;

  const std::shared_ptr<SharedMap> map = findMap(graph.resolve("tsdf_fusion"));
  ASSERT_NE(map, nullptr);
  EXPECT_TRUE(map->locked([&](FusedMap& fused) { return readMap(fused.map()) == readMap(offline->map()); }));
}

// A folder of frames that is played into a listener.
class PlayedFolder : public testing::Test {
 protected:
  PlayedFolder()
      : graph_(std::string("played_") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        diagnostics_(graph_.handle()),
        depth_(graph_.handle(), "depth/image"),
        color_(graph_.handle(), "rgb/image") {
    const auto writer = createTumFolder(room_);
    for (const RgbdFrame& frame : simulatedFrames(smallRoom(4))) writer->write(frame);
    writer->finish();
    graph_.handle().setParam("acquisition/recording", room_);
  }

  const TemporaryFolder folder_;
  const std::string room_ = folder_ / "room";
  NodeletGraph graph_;
  const Diagnostics diagnostics_;
  Listener<sensor_msgs::Image> depth_, color_;
};

TEST_F(PlayedFolder, WithBadColourIsPlayedWithoutAndSaysSo) {
  writePng(readTimedFiles(room_ + "/rgb.txt")[1].path, cv::Mat(60, 80, CV_8UC3, cv::Scalar(1, 2, 3)));
  ASSERT_TRUE(graph_.load("acquisition"));
  EXPECT_TRUE(diagnostics_.says("acquisition", diagnostic_msgs::DiagnosticStatus::WARN, "80x60"));
  EXPECT_TRUE(depth_.awaitCount(4));
  EXPECT_TRUE(color_.awaitCount(3));
}

TEST_F(PlayedFolder, ThatCannotBeRegisteredIsReadToItsEndAndSaysSo) {
  const std::string camera = folder_ / "camera.yaml";
  writeText(
      camera,
      "image_width: 320\nimage_height: 240\ncamera_matrix: {data: [262, 0, 160, 0, 262, 120, 0, 0, 1]}\n"
      "distortion_model: plumb_bob\ndistortion_coefficients: {data: [0.1, 0, 0, 0, 0]}\n");
  graph_.handle().setParam("acquisition/camera_file", camera);
  graph_.handle().setParam("acquisition/device", "none such");
  ASSERT_TRUE(graph_.load("acquisition"));
  const auto status = diagnostics_.await("acquisition", [](const diagnostic_msgs::DiagnosticStatus& said) {
    return valueOf(said, "dropped: not registered") == "4";
  });
  EXPECT_EQ(status.level, +diagnostic_msgs::DiagnosticStatus::ERROR);
  EXPECT_NE(status.message.find("none such"), std::string::npos) << status.message;
}

}  // namespace
}  // namespace depth_fusion
