// Topics as users have them: mistyped, and with two publishers.
#include <atomic>
#include <thread>

#include "support/diagnostics.h"
#include "support/live_graph.h"
#include "support/other_camera.h"

namespace depth_fusion {
namespace {

using diagnostic_msgs::DiagnosticStatus;

// A camera that sends the same view over and over.
class SteadyCamera {
 public:
  SteadyCamera(FakeCamera& camera, RgbdFrame frame)
      : thread_([this, &camera, frame]() mutable {
          for (; sending_; ros::WallDuration(0.05).sleep()) {
            camera.publish(frame);
            frame.stamp_s += 0.05;
          }
        }) {}
  ~SteadyCamera() {
    sending_ = false;
    thread_.join();
  }

 private:
  std::atomic<bool> sending_{true};
  std::thread thread_;
};

using Topics = LiveGraph;

TEST_F(Topics, WithTwoPublishersAreNamedAndTheMapStays) {
  const Diagnostics diagnostics(graph_.handle());
  loadTracking();
  const SteadyCamera steady(camera_, simulatedFrames(smallRoom(1)).front());
  const auto first = map_status_.await([](const MapStatus& status) { return status.fused; });
  ASSERT_NE(first, nullptr);
  {
    const OtherCamera other(graph_.resolve("depth/image"));
    EXPECT_TRUE(diagnostics.says("texture_odometry", DiagnosticStatus::WARN,
                                 "has two publishers, " + ros::this_node::getName()));
    const DiagnosticStatus status = diagnostics.await("texture_odometry", [](const DiagnosticStatus& said) {
      return !valueOf(said, "dropped: another publisher").empty();
    });
    EXPECT_GE(status.level, 0) << "its images are counted";
  }
  const size_t before = map_status_.count();
  EXPECT_TRUE(map_status_.awaitCount(before + 5));
  for (const auto& status : map_status_.all()) EXPECT_EQ(status->generation, first->generation);
}

TEST_F(Topics, ThatNobodyPublishesAreNamedWithThoseThatAre) {
  NodeletGraph elsewhere("mistyped");
  const Diagnostics diagnostics(elsewhere.handle());
  ASSERT_TRUE(elsewhere.load("texture_odometry"));
  for (const std::string& words :
       {"nobody publishes " + elsewhere.resolve("depth/image"), graph_.resolve("depth/image"),
        "nobody publishes " + elsewhere.resolve("depth/camera_info"), graph_.resolve("depth/camera_info"),
        std::string("depth_topic:=")})
    EXPECT_TRUE(diagnostics.says("texture_odometry", DiagnosticStatus::WARN, words)) << words;
}

TEST_F(Topics, WithoutColourAreNoProblem) {
  const Diagnostics diagnostics(graph_.handle());
  NodeletGraph depth_only("depth_only");
  ros::Publisher depth = depth_only.handle().advertise<sensor_msgs::Image>("depth/image", 10);
  ros::Publisher info = depth_only.handle().advertise<sensor_msgs::CameraInfo>("depth/camera_info", 10);
  const Diagnostics said(depth_only.handle());
  Listener<MapStatus> map_status(depth_only.handle(), "tsdf_fusion/status");
  depth_only.loadTracking();
  ASSERT_TRUE(eventually([&] { return depth.getNumSubscribers() > 0 && info.getNumSubscribers() > 0; }));
  for (const RgbdFrame& frame : simulatedFrames(smallRoom(5))) {
    const std_msgs::Header header = camera_.headerOf(frame);
    info.publish(makeCameraInfo(header, frame.intrinsics));
    depth.publish(
        boost::make_shared<sensor_msgs::Image>(makeDepthImage(header, frame.depth, frame.depth_unit_m)));
    const auto status = map_status.awaitStamp(header.stamp);
    ASSERT_NE(status, nullptr);
    EXPECT_TRUE(status->fused) << status->reason;
  }
  EXPECT_TRUE(said.says("texture_odometry", DiagnosticStatus::OK, "nobody publishes colour"));
}

}  // namespace
}  // namespace depth_fusion
