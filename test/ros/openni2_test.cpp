// A camera and an .oni file through OpenNI2 itself, from the driver to the map; and what goes wrong with
// cameras.
#include <depth_fusion/ExportMesh.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <sensor_msgs/SetCameraInfo.h>

#include <cstring>

#include "depth_fusion/evaluation/mesh_error.h"
#include "depth_fusion/pipeline/reconstruction_pipeline.h"
#include "depth_fusion/surface_mesh/ply.h"
#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "support/nodelet_graph.h"
#include "support/test_device.h"

namespace depth_fusion {
namespace {

using diagnostic_msgs::DiagnosticArray;
using diagnostic_msgs::DiagnosticStatus;
using geometry_msgs::PoseWithCovarianceStamped;
using sensor_msgs::CameraInfo;
using sensor_msgs::Image;

constexpr int kFrames = 60;
constexpr double kMaxOffset_m = 0.01;
constexpr double kMaxTurn_rad = 0.0087;

// Exact depth: the error of the map does not depend on how many frames a busy machine drops.
SimulationOptions scene() {
  SimulationOptions options = smallRoom(kFrames);
  options.noise = false;
  return options;
}

const std::vector<RgbdFrame>& roomFrames() {
  static const std::vector<RgbdFrame> frames = simulatedFrames(scene());
  return frames;
}

Pose poseOf(const PoseWithCovarianceStamped& message) {
  geometry_msgs::Transform transform;
  transform.translation.x = message.pose.pose.position.x;
  transform.translation.y = message.pose.pose.position.y;
  transform.translation.z = message.pose.pose.position.z;
  transform.rotation = message.pose.pose.orientation;
  return fromMessage(transform);
}

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

class OpenNi2 : public testing::Test {
 protected:
  OpenNi2()
      : graph_(std::string("openni2_") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        device_(roomFrames()),
        diagnostics_(graph_.handle(), "/diagnostics"),
        poses_(graph_.handle(), "icp_tracking/pose"),
        tracker_(graph_.handle(), "icp_tracking/status") {
    device_.control.fps = 10.0;  // the test machine has more to do
    device_.apply();
    set("device_id", std::string("#1"));
    set("depth_mode", device_.mode());
    set("color_mode", device_.mode());
    graph_.handle().setParam("icp_tracking/level_start", false);
  }

  template <class Value>
  void set(const std::string& name, const Value& value) {
    graph_.handle().setParam("acquisition/" + name, value);
  }

  // The nodelets that track and fuse know each other before the camera does.
  void loadAll() {
    graph_.loadTracking();
    ASSERT_TRUE(graph_.load("surface_mesh"));
    ASSERT_TRUE(graph_.load("acquisition"));
  }

  // That acquisition says so from now on.
  bool says(int level, const std::string& words) {
    const size_t before = diagnostics_.count();
    size_t seen = 0;
    return diagnostics_.await([&](const DiagnosticArray& array) {
      if (++seen <= before) return false;
      return std::any_of(array.status.begin(), array.status.end(), [&](const DiagnosticStatus& status) {
        return status.name.find(graph_.resolve("acquisition").substr(1)) != std::string::npos &&
               status.level == level && status.message.find(words) != std::string::npos;
      });
    }) != nullptr;
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
    EXPECT_LT(compareMesh(mesh, T_W_map, SimulatedRecording(scene()).scene().surface).surface_m.mean, 0.002);
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

  NodeletGraph graph_;
  TestDevice device_;
  Listener<DiagnosticArray> diagnostics_;
  Listener<PoseWithCovarianceStamped> poses_;
  Listener<TrackerStatus> tracker_;
};

TEST_F(OpenNi2, ACameraBecomesTheMapOfABag) {
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

TEST_F(OpenNi2, AnOniFileBecomesTheMapOfABag) {
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

TEST_F(OpenNi2, UnpluggedItWaitsAndGoesOnWithTheSameMap) {
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

TEST_F(OpenNi2, LateColourIsSaidAndDepthGoesOn) {
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

TEST_F(OpenNi2, DroppedFramesAreCountedAndBridged) {
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
  EXPECT_NE(diagnostics_.await([&](const DiagnosticArray& array) {
    for (const DiagnosticStatus& status : array.status) {
      for (const auto& value : status.values) {
        if (value.key.find("missed by the camera") != std::string::npos) return true;
      }
    }
    return false;
  }),
            nullptr);
}

TEST_F(OpenNi2, WithoutRegistrationDepthHasItsOwnFrameAndAWarning) {
  device_.control.registers = false;
  device_.apply();
  Listener<Image> depth(graph_.handle(), "depth/image"), color(graph_.handle(), "rgb/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(says(DiagnosticStatus::WARN, "cannot register depth to colour"));
  ASSERT_TRUE(depth.awaitCount(1) && color.awaitCount(1));
  EXPECT_EQ(depth.all()[0]->header.frame_id, "camera_depth_optical_frame");
  EXPECT_EQ(color.all()[0]->header.frame_id, "camera_rgb_optical_frame");
}

TEST_F(OpenNi2, AModeThatItLacksIsSaidUntilItHasIt) {
  device_.control.refuses_modes = true;
  device_.apply();
  Listener<Image> depth(graph_.handle(), "depth/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(says(DiagnosticStatus::ERROR, "refuses depth_mode 320x240@30"));
  EXPECT_EQ(depth.count(), 0u);
  device_.control.refuses_modes = false;
  device_.apply();
  EXPECT_TRUE(depth.awaitCount(1));
}

TEST_F(OpenNi2, WithoutACameraItSaysWhatItLookedForAndWaits) {
  device_.control.plugged = false;
  device_.apply();
  set("device_id", std::string(kFirstSerial));
  Listener<Image> depth(graph_.handle(), "depth/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(says(DiagnosticStatus::ERROR, std::string("no camera ") + kFirstSerial));
  device_.control.plugged = true;
  device_.apply();
  EXPECT_TRUE(depth.awaitCount(1));
}

TEST_F(OpenNi2, PublishesTheMemoryThatTheDriverWroteTo) {
  device_.control.writes_addresses = true;
  device_.apply();
  set("ir_mode", device_.mode());
  Listener<Image> depth(graph_.handle(), "depth/image"), color(graph_.handle(), "rgb/image"),
      ir(graph_.handle(), "ir/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  for (Listener<Image>* images : {&depth, &color, &ir}) {
    ASSERT_TRUE(images->awaitCount(5));
    for (const auto& image : images->all()) {
      const void* address = nullptr;
      std::memcpy(&address, image->data.data(), sizeof(address));
      EXPECT_EQ(address, image->data.data());
    }
  }
}

TEST_F(OpenNi2, StampsGoByTheCamerasClock) {
  device_.control.fps = 20.0;
  device_.apply();
  set("depth_time_offset", 0.5);
  set("color_time_offset", 0.0);
  Listener<Image> depth(graph_.handle(), "depth/image"), color(graph_.handle(), "rgb/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(depth.awaitCount(41) && color.awaitCount(41));
  EXPECT_LT(depth.all()[40]->header.stamp.toSec(), ros::Time::now().toSec() + 0.5);
  int regular = 0, paired = 0;
  for (size_t i = 0; i < 40; ++i) {
    const double stamp_s = depth.all()[i]->header.stamp.toSec(),
                 next_s = depth.all()[i + 1]->header.stamp.toSec();
    const double periods = (next_s - stamp_s) / 0.05;
    regular += std::abs(periods - std::round(periods)) < 0.02 ? 1 : 0;
    for (const auto& image : color.all())
      paired += std::abs(image->header.stamp.toSec() + 0.5 - stamp_s) < 0.001 ? 1 : 0;
  }
  EXPECT_GE(regular, 30) << "whatever the delays of this machine";
  EXPECT_GE(paired, 30);
}

TEST_F(OpenNi2, CameraInfoIsTheCalibrationOrTheFieldOfView) {
  const TemporaryFolder folder;
  CameraInfo calibration = makeCameraInfo({}, roomFrames().front().intrinsics);
  calibration.D = {0.1, 0.0, 0.0, 0.0, 0.0};
  set("depth_registration", false);
  set("rgb_camera_info_url", "file://" + folder.path() + "/rgb.yaml");
  Listener<CameraInfo> depth(graph_.handle(), "depth/camera_info"), color(graph_.handle(), "rgb/camera_info");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(depth.awaitCount(1) && color.awaitCount(1));
  for (const auto& info : {depth.all()[0], color.all()[0]}) {
    EXPECT_NEAR(info->K[0], 262.5, 1e-3);
    EXPECT_NEAR(info->K[5], 119.5, 1e-9);
    EXPECT_EQ(info->D[0], 0.0);
  }
  ros::ServiceClient client =
      graph_.handle().serviceClient<sensor_msgs::SetCameraInfo>("rgb/set_camera_info");
  sensor_msgs::SetCameraInfo request;
  request.request.camera_info = calibration;
  ASSERT_TRUE(client.call(request));
  ASSERT_TRUE(request.response.success) << request.response.status_message;
  EXPECT_NE(color.await([](const CameraInfo& info) { return info.D[0] == 0.1; }), nullptr);
  EXPECT_TRUE(std::ifstream(folder / "rgb.yaml").good()) << "kept";
}

TEST_F(OpenNi2, ExposureChangesWhileItRuns) {
  Listener<Image> color(graph_.handle(), "rgb/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(color.awaitCount(1));
  EXPECT_EQ(device_.settings(), "1 1 0 0");
  dynamic_reconfigure::Reconfigure change;
  change.request.config.bools.resize(1);
  change.request.config.bools[0].name = "auto_exposure";
  change.request.config.ints.resize(1);
  change.request.config.ints[0].name = "exposure";
  change.request.config.ints[0].value = 40;
  ASSERT_TRUE(graph_.handle()
                  .serviceClient<dynamic_reconfigure::Reconfigure>("acquisition/set_parameters")
                  .call(change));
  EXPECT_TRUE(eventually([&] { return device_.settings() == "0 1 40 0"; }));
}

TEST_F(OpenNi2, ARecordingOrACameraButNotBoth) {
  set("recording", std::string("room.bag"));
  EXPECT_FALSE(graph_.load("acquisition"));
}

}  // namespace
}  // namespace depth_fusion
