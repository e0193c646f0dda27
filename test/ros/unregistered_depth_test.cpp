// Drivers whose depth is not registered to colour, and whose lenses distort: camera_info and tf say how to
// put that right.
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include "depth_fusion/surface_mesh/surface_mesh.h"
#include "ros/in_process/frames.h"
#include "ros/in_process/shared_map.h"
#include "support/diagnostics.h"
#include "support/distorted_view.h"
#include "tools/evaluation/mesh_error.h"

namespace depth_fusion {
namespace {

constexpr CameraIntrinsics kDepthCamera{320, 240, 290.0, 290.0, 160.0, 121.0};
constexpr CameraIntrinsics kColorCamera{360, 270, 300.0, 298.0, 182.0, 131.0};
const LensDistortion kDepthLens = {-0.12, 0.1, 0.001, -0.001, -0.02};
const LensDistortion kColorLens = {0.12, -0.2, -0.002, 0.001, 0.08};
const Pose kT_C_D = motionOf({0.3, -0.5, 0.4}, {-0.025, 0.001, -0.003});

// The room as such a sensor sees it, every second frame of its path.
std::vector<RgbdFrame> unregisteredFrames(int count) {
  const SimulatedRecording room{SimulationOptions()};
  std::vector<RgbdFrame> frames;
  for (int i = 0; i < count; ++i) {
    const StampedPose pose = room.poseOf(2 * i);
    RgbdFrame frame;
    frame.stamp_s = toRosTime(100.0 + pose.stamp_s).toSec();
    frame.intrinsics = kDepthCamera;
    frame.distortion = kDepthLens;
    frame.depth = distortedView(room.scene().surface, kDepthCamera, kDepthLens, pose.T_W_D).depth_m;
    frame.color_intrinsics = kColorCamera;
    frame.color_distortion = kColorLens;
    frame.color =
        distortedView(room.scene().surface, kColorCamera, kColorLens, pose.T_W_D * kT_C_D.inverse()).color;
    frame.T_W_D = pose.T_W_D;
    frames.push_back(inMillimetres(frame));
  }
  return frames;
}

class UnregisteredDepth : public testing::Test {
 protected:
  UnregisteredDepth()
      : name_(testing::UnitTest::GetInstance()->current_test_info()->name()),
        graph_("unregistered_" + name_),
        camera_(graph_.handle(), name_ + "_depth", name_ + "_color"),
        diagnostics_(graph_.handle()) {}

  void publishTf() {
    broadcaster_.sendTransform(
        makeTransform(makeHeader(ros::Time::now(), name_ + "_color"), name_ + "_depth", kT_C_D));
  }

  // Some nodelet says so.
  bool isDiagnosed(const std::vector<std::string>& words) const {
    const auto status = diagnostics_.await("", [&](const diagnostic_msgs::DiagnosticStatus& said) {
      return said.level > 0 && std::all_of(words.begin(), words.end(), [&](const std::string& word) {
               return said.message.find(word) != std::string::npos;
             });
    });
    return status.level > 0;
  }

  // The frames end in the right pose and on the right surface.
  void expectTracked(const Pose& T_D_camera) {
    Listener<MapStatus> map_status(graph_.handle(), "tsdf_fusion/status");
    Listener<geometry_msgs::PoseWithCovarianceStamped> poses(graph_.handle(), "icp_tracking/pose");
    Listener<TexturedFrameMessage> textured(graph_.handle(), "texture_odometry/frame");
    publishTf();
    graph_.handle().setParam("map/voxel_size_m", 0.01);
    graph_.loadTracking();
    ASSERT_TRUE(camera_.awaitSubscribers());
    const std::vector<RgbdFrame> frames = unregisteredFrames(8);
    std::vector<Pose> found;
    for (const RgbdFrame& frame : frames) {
      camera_.publish(frame);
      const auto status = map_status.awaitStamp(toRosTime(frame.stamp_s));
      ASSERT_NE(status, nullptr);
      ASSERT_TRUE(status->fused) << status->reason;
      found.push_back(fromMessage(poses.awaitStamp(toRosTime(frame.stamp_s))->pose.pose));
    }
    const auto motion = textured.awaitStamp(toRosTime(frames.back().stamp_s))->payload->texture.motion;
    EXPECT_TRUE(motion.found) << motion.reason;
    const Pose T_W_first = *frames.front().T_W_D * T_D_camera, T_W_last = *frames.back().T_W_D * T_D_camera;
    const Pose error = (T_W_first.inverse() * T_W_last).inverse() * found.front().inverse() * found.back();
    EXPECT_LT(error.translation().norm(), 0.005);
    EXPECT_LT(rotationAngle(error), 0.005);
    const auto map = findMap(graph_.resolve("tsdf_fusion"));
    const TriangleMesh mesh = map->locked([&](FusedMap& fused) {
      TriangleMesh surface;
      exportSurfaceMesh(*map->compute, fused.map(), surface);
      return surface;
    });
    const SimulatedRecording room{SimulationOptions()};
    const MeshError surface = compareMesh(mesh, T_W_first * found.front().inverse(), room.scene().surface);
    EXPECT_GT(surface.area_m2, 2.0);
    EXPECT_LT(surface.surface_m.mean, 0.002);
    EXPECT_LT(surface.surface_m.percentile95, 0.006);
  }

  std::string name_;
  NodeletGraph graph_;
  FakeCamera camera_;
  Diagnostics diagnostics_;
  tf2_ros::StaticTransformBroadcaster broadcaster_;
};

TEST_F(UnregisteredDepth, IsTrackedWhereItIs) { expectTracked(Pose::Identity()); }

TEST_F(UnregisteredDepth, IsTrackedAsTheColorCameraSeesIt) {
  graph_.handle().setParam("registration/depth_to_color", true);
  expectTracked(kT_C_D.inverse());
}

TEST_F(UnregisteredDepth, GoesWithoutColourUntilTfConnectsThemAndSaysWhatIsMissing) {
  Listener<TexturedFrameMessage> textured(graph_.handle(), "texture_odometry/frame");
  ASSERT_TRUE(graph_.load("texture_odometry"));
  ASSERT_TRUE(camera_.awaitSubscribers());
  const std::vector<RgbdFrame> frames = unregisteredFrames(2);
  camera_.publish(frames[0]);
  EXPECT_TRUE(isDiagnosed({name_ + "_depth", name_ + "_color", "tf", "static_transform_publisher"}));
  ASSERT_TRUE(textured.awaitCount(1));
  EXPECT_TRUE(textured.all().front()->payload->sensor->rgbd.color.empty());
  publishTf();
  RgbdFrame frame = frames[1];
  bool came = false;
  for (int i = 0; i < 100 && !came; ++i, frame.stamp_s += 1.0) {
    camera_.publish(frame);
    const auto message = textured.awaitStamp(toRosTime(frame.stamp_s), 1.0);
    came = message != nullptr && !message->payload->sensor->rgbd.color.empty();
  }
  ASSERT_TRUE(came);
  EXPECT_TRUE(textured.all().back()->payload->sensor->rgbd.T_C_D->isApprox(kT_C_D, 1e-6));
}

TEST_F(UnregisteredDepth, CameraModelsThatAreNotKnownAreNamed) {
  Listener<TexturedFrameMessage> textured(graph_.handle(), "texture_odometry/frame");
  ros::Publisher info = graph_.handle().advertise<sensor_msgs::CameraInfo>("depth/camera_info", 10);
  ASSERT_TRUE(graph_.load("texture_odometry"));
  publishTf();
  ASSERT_TRUE(camera_.awaitSubscribers());
  const auto publish = [&](const std::string& model, const LensDistortion& lens) {
    const RgbdFrame frame = unregisteredFrames(1).front();
    sensor_msgs::CameraInfo message = makeCameraInfo(camera_.headerOf(frame), kDepthCamera, lens);
    message.distortion_model = model;
    ASSERT_TRUE(eventually([&] { return info.getNumSubscribers() > 0; }));
    camera_.publishColor(frame);
    ros::Publisher depth = graph_.handle().advertise<sensor_msgs::Image>("depth/image", 10);
    info.publish(message);
    ros::WallDuration(0.2).sleep();
    sensor_msgs::Image image = makeDepthImage(camera_.headerOf(frame), frame.depth, frame.depth_unit_m);
    image.header.stamp = ros::Time::now();
    depth.publish(boost::make_shared<sensor_msgs::Image>(image));
  };
  publish("equidistant", kDepthLens);
  EXPECT_TRUE(isDiagnosed({"equidistant", "plumb_bob"}));
  publish("plumb_bob", {-1.2, 0.0, 0.0, 0.0, 0.0});
  EXPECT_TRUE(isDiagnosed({"the depth camera", "folds the image"}));
  EXPECT_EQ(textured.count(), 0u);
}

}  // namespace
}  // namespace depth_fusion
