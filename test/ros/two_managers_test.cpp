// Two nodelet managers, a process each, that map what two cameras see; the launch file has the nodelets.
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_listener.h>

#include "support/nodelet_graph.h"

namespace depth_fusion {
namespace {

// A camera, and what the manager in its namespace says of it.
struct Side {
  explicit Side(const std::string& name)
      : handle("/" + name),
        map(handle, "tsdf_fusion/status"),
        camera(handle, name + "_optical"),
        reset(handle.serviceClient<std_srvs::Trigger>("tsdf_fusion/reset_volume")) {}

  bool ready() {
    return camera.awaitSubscribers() && eventually([&] { return map.connected(); });
  }
  // The map after a frame; null if no answer comes.
  Listener<MapStatus>::Ptr mapped(const RgbdFrame& frame) {
    camera.publish(frame);
    return map.awaitStamp(toRosTime(frame.stamp_s));
  }

  ros::NodeHandle handle;
  Listener<MapStatus> map;
  FakeCamera camera;
  ros::ServiceClient reset;
};

TEST(TwoManagers, MapEachForItself) {
  ros::AsyncSpinner spinner(2);
  spinner.start();
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  Side left("left_camera"), right("right_camera");
  ASSERT_TRUE(left.ready() && right.ready());
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(6));
  uint64_t blocks = 0;
  for (size_t i = 0; i + 1 < frames.size(); ++i) {
    const auto l = left.mapped(frames[i]), r = right.mapped(frames[i]);
    ASSERT_TRUE(l != nullptr && r != nullptr);
    EXPECT_TRUE(l->fused) << l->reason;
    EXPECT_TRUE(r->fused) << r->reason;
    EXPECT_EQ(l->blocks, r->blocks);
    blocks = r->blocks;
    const ros::Time stamp = toRosTime(frames[i].stamp_s);
    EXPECT_TRUE(eventually([&] { return buffer.canTransform("left_map", "left_camera_optical", stamp); }));
    EXPECT_TRUE(eventually([&] { return buffer.canTransform("right_map", "right_camera_optical", stamp); }));
    EXPECT_FALSE(buffer.canTransform("left_map", "right_camera_optical", stamp));
  }

  std_srvs::Trigger service;
  ASSERT_TRUE(left.reset.call(service));
  ASSERT_TRUE(service.response.success) << service.response.message;
  const auto l = left.mapped(frames.back()), r = right.mapped(frames.back());
  ASSERT_TRUE(l != nullptr && r != nullptr);
  EXPECT_LT(l->blocks, blocks);
  EXPECT_GE(r->blocks, blocks);
}

}  // namespace
}  // namespace depth_fusion
