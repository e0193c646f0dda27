// A bag through the real roscore, rosbag play and nodelet manager; the launch file has the nodelets.
#include <depth_fusion/ExportMesh.h>
#include <depth_fusion/SetMode.h>
#include <tf2_ros/transform_listener.h>

#include <cstdlib>
#include <thread>

#include "depth_fusion/surface_mesh/ply.h"
#include "ros/bags/open_recording.h"
#include "support/diagnostics.h"
#include "support/temporary_folder.h"
#include "tools/evaluation/mesh_error.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 60;

// Exact depth: what the map's error is does not depend on how many frames a busy machine drops.
SimulationOptions scene() {
  SimulationOptions options = smallRoom(kFrames);
  options.noise = false;
  return options;
}

uint64_t droppedOf(const FrameAccount& account) {
  uint64_t sum = 0;
  for (const uint64_t frames : account.dropped) sum += frames;
  return sum;
}

void expectModeIsServed(ros::NodeHandle& handle) {
  SetMode service;
  service.request.mode = SetMode::Request::MAPPING;
  EXPECT_TRUE(handle.serviceClient<SetMode>("tsdf_fusion/set_mode").call(service));
  EXPECT_TRUE(service.response.success);
}

// Those before may be dropped while the kernels are built.
const RgbdFrame& firstTracked(const std::vector<RgbdFrame>& frames, const Listener<TrackerStatus>& tracker) {
  const ros::Time stamp = tracker.all().front()->header.stamp;
  return *std::find_if(frames.begin(), frames.end(),
                       [&](const RgbdFrame& f) { return toRosTime(f.stamp_s) == stamp; });
}

TEST(Replay, ABagBecomesPosesAndAMapAndNoFrameIsUnaccountedFor) {
  const TemporaryFolder folder;
  const std::string path = folder / "room.bag";
  const std::vector<RgbdFrame> frames = simulatedFrames(scene());
  const auto bag = createBag(path);
  for (RgbdFrame frame : frames) {
    frame.T_W_D.reset();  // no poses on tf but the tracker's
    bag->write(frame);
  }
  bag->finish();

  ros::NodeHandle handle("/camera");
  ros::AsyncSpinner spinner(2);
  spinner.start();
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  Listener<TrackerStatus> tracker(handle, "icp_tracking/status");
  Listener<MapStatus> map(handle, "tsdf_fusion/status");
  const Diagnostics diagnostics(handle);
  ASSERT_TRUE(eventually([&] { return tracker.connected() && map.connected(); }));
  // The nodelets have found each other.
  diagnostics.await("texture_odometry", [](const auto& said) { return valueOf(said, "trackers") == "1"; });
  // Slowly, for the test machine has more to do; the services are called meanwhile.
  std::thread player([&] {
    EXPECT_EQ(std::system(("rosbag play --quiet --clock --delay=1 --rate=0.2 " + path).c_str()), 0);
  });
  EXPECT_NE(map.await([](const MapStatus& status) { return status.fused; }), nullptr);
  expectModeIsServed(handle);
  player.join();

  const ros::Time last = toRosTime(frames.back().stamp_s);
  ASSERT_NE(tracker.awaitStamp(last), nullptr);
  const auto status = map.awaitStamp(last);
  ASSERT_NE(status, nullptr);
  EXPECT_TRUE(status->fused) << status->reason;
  const TrackerStatus tracking = *tracker.awaitStamp(last);
  const Diagnostics::Status odometry = diagnostics.await("texture_odometry", [](const auto& said) {
    return valueOf(said, "frames received") == std::to_string(kFrames);
  });
  EXPECT_EQ(tracking.frames.received + framesDropped(odometry), uint64_t{kFrames});
  EXPECT_EQ(tracking.frames.processed + droppedOf(tracking.frames), tracking.frames.received);
  EXPECT_EQ(status->frames.processed + droppedOf(status->frames), tracking.frames.processed);

  const RgbdFrame& first = firstTracked(frames, tracker);
  const auto pose = [&](const RgbdFrame& frame) {
    const ros::Time stamp = toRosTime(frame.stamp_s);
    EXPECT_TRUE(eventually([&] { return buffer.canTransform("map", "camera_rgb_optical_frame", stamp); }));
    return fromMessage(buffer.lookupTransform("map", "camera_rgb_optical_frame", stamp).transform);
  };
  const Pose motion = pose(first).inverse() * pose(frames.back());
  const Pose error = (first.T_W_D->inverse() * *frames.back().T_W_D).inverse() * motion;
  EXPECT_LT(error.translation().norm(), 0.01);
  EXPECT_LT(rotationAngle(error), 0.0087);

  ros::ServiceClient client = handle.serviceClient<ExportMesh>("surface_mesh/export_mesh");
  ASSERT_TRUE(client.waitForExistence(ros::Duration(kPatience_s)));
  ExportMesh mesh;
  mesh.request.path = folder / "room.ply";
  ASSERT_TRUE(client.call(mesh));
  ASSERT_TRUE(mesh.response.success) << mesh.response.message;
  const Pose T_W_map = *first.T_W_D * pose(first).inverse();
  const MeshError surface =
      compareMesh(readPly(mesh.request.path), T_W_map, SimulatedRecording(scene()).scene().surface);
  EXPECT_LT(surface.surface_m.mean, 0.002);
}

}  // namespace
}  // namespace depth_fusion
