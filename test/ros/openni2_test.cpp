// A camera and an .oni file through OpenNI2 itself, from the driver to the map.
#include <depth_fusion/ExportMesh.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>

#include <cstring>

#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "support/openni2_graph.h"
#include "tools/evaluation/mesh_error.h"

namespace depth_fusion {
namespace {

using geometry_msgs::PoseWithCovarianceStamped;
using sensor_msgs::Image;

constexpr double kMaxOffset_m = 0.01;
constexpr double kMaxTurn_rad = 0.0087;

Pose poseOf(const PoseWithCovarianceStamped& message) { return fromMessage(message.pose.pose); }

Eigen::AlignedBox3f boundsOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const MeshVertex& vertex : mesh.vertices) box.extend(vertex.position_W);
  return box;
}

// What the same frames make offline, in the frame of the first, as a bag does bit for bit (see
// lossless_test).
Eigen::AlignedBox3f boundsOfBag() {
  ComputeContext compute;
  ReconstructionPipeline pipeline(compute, PipelineParameters(), roomFrames().front().intrinsics);
  for (const RgbdFrame& frame : roomFrames()) pipeline.processFrame(frame);
  TriangleMesh mesh;
  exportSurfaceMesh(compute, pipeline.map(), mesh);
  return boundsOf(mesh);
}

class OpenNi2Map : public OpenNi2 {
 protected:
  OpenNi2Map()
      : poses_(graph_.handle(), "icp_tracking/pose"), tracker_(graph_.handle(), "icp_tracking/status") {
    graph_.handle().setParam("icp_tracking/level_start", false);
  }

  // The nodelets that track and fuse know each other before the camera does.
  void loadAll() {
    graph_.loadTracking();
    ASSERT_TRUE(graph_.load("surface_mesh"));
    ASSERT_TRUE(graph_.load("acquisition"));
  }

  // The first pose of the recording's frame; null if none comes.
  boost::shared_ptr<const PoseWithCovarianceStamped> awaitPoseOf(const Listener<Image>& depth, int frame) {
    const cv::Mat& pixels = roomFrames()[static_cast<size_t>(frame)].depth;
    const auto image = depth.await([&](const Image& i) {
      return std::memcmp(i.data.data(), pixels.data, pixels.total() * pixels.elemSize()) == 0;
    });
    if (image == nullptr) return nullptr;
    return poses_.await(
        [&](const PoseWithCovarianceStamped& pose) { return pose.header.stamp >= image->header.stamp; });
  }

  void moveTo(int frame) {
    device_.control.at = frame;
    device_.apply();
  }

  void expectMotion(const Pose& first, const Pose& last, int last_frame) {
    const Pose truth =
        roomFrames().front().T_W_D->inverse() * *roomFrames()[static_cast<size_t>(last_frame)].T_W_D;
    const Pose error = truth.inverse() * first.inverse() * last;
    EXPECT_LT(error.translation().norm(), kMaxOffset_m);
    EXPECT_LT(rotationAngle(error), kMaxTurn_rad);
  }

  void expectMesh(const Pose& first) {
    const TemporaryFolder folder;
    ros::ServiceClient client = graph_.handle().serviceClient<ExportMesh>("surface_mesh/export_mesh");
    ASSERT_TRUE(client.waitForExistence(ros::Duration(kPatience_s)));
    ExportMesh request;
    request.request.path = folder / "room.ply";
    ASSERT_TRUE(client.call(request));
    ASSERT_TRUE(request.response.success) << request.response.message;
    const TriangleMesh mesh = readPly(request.request.path);
    const Pose T_W_map = *roomFrames().front().T_W_D * first.inverse();
    EXPECT_LT(compareMesh(mesh, T_W_map, SimulatedRecording(roomOptions()).scene().surface).surface_m.mean,
              0.002);
    static const Eigen::AlignedBox3f expected = boundsOfBag();
    const Eigen::AlignedBox3f bounds = boundsOf(mesh);
    EXPECT_LT((bounds.min() - expected.min()).cwiseAbs().maxCoeff(), 0.03f);
    EXPECT_LT((bounds.max() - expected.max()).cwiseAbs().maxCoeff(), 0.03f);
  }

  bool neverLost() const {
    for (const auto& status : tracker_.all()) {
      if (status->state >= TrackerStatus::LOST) return false;
    }
    return true;
  }

  Listener<PoseWithCovarianceStamped> poses_;
  Listener<TrackerStatus> tracker_;
};

TEST_F(OpenNi2Map, ACameraBecomesTheMapOfABag) {
  Listener<Image> depth(graph_.handle(), "depth/image");
  loadAll();
  const auto first = awaitPoseOf(depth, 0);
  ASSERT_NE(first, nullptr);
  moveTo(kFrames - 1);
  const auto last = awaitPoseOf(depth, kFrames - 1);
  ASSERT_NE(last, nullptr);
  EXPECT_TRUE(neverLost());
  expectMotion(poseOf(*first), poseOf(*last), kFrames - 1);
  expectMesh(poseOf(*first));
}

TEST_F(OpenNi2Map, AnOniFileBecomesTheMapOfABag) {
  const TemporaryFolder folder;
  device_.control.fps = 30.0;
  device_.apply();
  device_.recordOni(folder / "room.oni", kFrames);
  set("device_id", folder / "room.oni");
  set("lossless", true);
  loadAll();
  ASSERT_TRUE(says(DiagnosticStatus::OK, "the recording has ended"));
  EXPECT_TRUE(neverLost());
  ASSERT_GE(poses_.count(), size_t{kFrames});
  expectMotion(poseOf(*poses_.all().front()), poseOf(*poses_.all().back()), kFrames - 1);
  expectMesh(poseOf(*poses_.all().front()));
}

TEST_F(OpenNi2Map, UnpluggedItWaitsAndGoesOnWithTheSameMap) {
  Listener<Image> depth(graph_.handle(), "depth/image");
  Listener<MapStatus> map(graph_.handle(), "tsdf_fusion/status");
  loadAll();
  const auto first = awaitPoseOf(depth, 0);
  ASSERT_NE(first, nullptr);
  moveTo(20);
  ASSERT_NE(awaitPoseOf(depth, 20), nullptr);
  device_.control.plugged = false;
  device_.apply();
  ASSERT_TRUE(says(DiagnosticStatus::ERROR, "plug"));
  device_.control.plugged = true;
  device_.apply();
  ASSERT_TRUE(says(DiagnosticStatus::OK, "running"));
  moveTo(40);
  const auto last = awaitPoseOf(depth, 40);
  ASSERT_NE(last, nullptr);
  EXPECT_TRUE(neverLost());
  expectMotion(poseOf(*first), poseOf(*last), 40);
  EXPECT_EQ(map.all().front()->generation, map.all().back()->generation);
}

TEST_F(OpenNi2Map, LateColourIsSaidAndDepthGoesOn) {
  Listener<Image> depth(graph_.handle(), "depth/image");
  loadAll();
  const auto first = awaitPoseOf(depth, 0);
  ASSERT_NE(first, nullptr);
  device_.control.late_color_s = 0.5;
  moveTo(20);
  ASSERT_TRUE(says(DiagnosticStatus::WARN, "colour too late"));
  const auto last = awaitPoseOf(depth, 20);
  ASSERT_NE(last, nullptr);
  EXPECT_TRUE(neverLost());
  expectMotion(poseOf(*first), poseOf(*last), 20);
  device_.control.late_color_s = 0.0;
  device_.apply();
  EXPECT_TRUE(says(DiagnosticStatus::OK, "running"));
}

TEST_F(OpenNi2Map, DroppedFramesAreCountedAndBridged) {
  Listener<Image> depth(graph_.handle(), "depth/image");
  loadAll();
  const auto first = awaitPoseOf(depth, 0);
  ASSERT_NE(first, nullptr);
  device_.control.drop = 3;
  moveTo(20);
  const auto last = awaitPoseOf(depth, 20);
  ASSERT_NE(last, nullptr);
  EXPECT_TRUE(neverLost());
  expectMotion(poseOf(*first), poseOf(*last), 20);
  const auto counted = diagnostics_.await("acquisition", [](const DiagnosticStatus& status) {
    return std::any_of(status.values.begin(), status.values.end(),
                       [](const diagnostic_msgs::KeyValue& value) {
                         return value.key.find("missed by the camera") != std::string::npos;
                       });
  });
  EXPECT_NE(counted.level, -1);
}

}  // namespace
}  // namespace depth_fusion
