// The graph of nodelets as a robot uses it: zero copies, modes, a full pool, unloading and reloading.
#include <atomic>
#include <thread>

#include "ros/in_process/frames.h"
#include "ros/in_process/shared_map.h"
#include "support/live_graph.h"

namespace depth_fusion {
namespace {

using Live = LiveGraph;

TEST_F(Live, ImagesAndModelViewsPassWithoutACopy) {
  Listener<sensor_msgs::Image> images(graph_.handle(), "depth/image");
  Listener<TexturedFrameMessage> textured(graph_.handle(), "texture_odometry/frame");
  Listener<TrackedFrameMessage> tracked(graph_.handle(), "icp_tracking/frame");
  Listener<MapViewMessage> views(graph_.handle(), "tsdf_fusion/model_view");
  Listener<MapViewMessage> also_views(graph_.handle(), "tsdf_fusion/model_view");
  loadTracking();
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(2));
  camera_.publishColor(frames[0]);
  const sensor_msgs::ImageConstPtr published = camera_.publishDepth(frames[0]);
  const auto stamp = camera_.headerOf(frames[0]).stamp;
  ASSERT_NE(views.awaitStamp(stamp), nullptr);
  EXPECT_EQ(images.awaitStamp(stamp).get(), published.get());
  const auto frame = textured.awaitStamp(stamp)->payload;
  EXPECT_EQ(frame->sensor->depth_message.get(), published.get());
  EXPECT_EQ(frame->sensor->rgbd.depth.data, published->data.data());
  EXPECT_EQ(frame->sensor->rgbd.color.data, frame->sensor->color_message->data.data());
  EXPECT_EQ(tracked.awaitStamp(stamp)->payload->sensor.get(), frame->sensor.get());
  EXPECT_EQ(views.awaitStamp(stamp).get(), also_views.awaitStamp(stamp).get());

  // What is held on to stays as it was published.
  const auto held = views.awaitStamp(stamp)->payload->view;
  const Pose before = held->T_W_D;
  fuse(frames[1]);
  EXPECT_TRUE(held->T_W_D.isApprox(before, 0.0));
  EXPECT_NE(views.awaitStamp(camera_.headerOf(frames[1]).stamp)->payload->view.get(), held.get());
}

TEST_F(Live, AFullPoolSaysWhatItLeavesOut) {
  graph_.handle().setParam("map/pool_mib", 1);
  loadTracking();
  const auto status = fuse(simulatedFrames(smallRoom(1)).front());
  ASSERT_NE(status, nullptr);
  EXPECT_TRUE(status->fused);
  EXPECT_NE(status->reason.find("the pool is full"), std::string::npos) << status->reason;
  EXPECT_GT(status->blocks_left_out, 0u);
  EXPECT_EQ(status->blocks + status->blocks_free, 1024u);
}

TEST_F(Live, ModesStopMappingAndTracking) {
  loadTracking();
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(16));
  fuseAll({frames.begin(), frames.begin() + 5});
  setMode(SetMode::Request::LOCALISATION);
  const auto localised = fuse(frames[5]);
  ASSERT_NE(localised, nullptr);
  EXPECT_FALSE(localised->fused);
  EXPECT_EQ(localised->mode, MapStatus::LOCALISATION);
  EXPECT_EQ(localised->blocks, map_status_.all()[4]->blocks);
  const auto tracked = track(frames[6]);
  EXPECT_EQ(tracked->state, TrackerStatus::TRACKING);
  EXPECT_EQ(tracked->prior, "texture");
  EXPECT_EQ(tracker_status_.all().front()->prior, "start");

  setMode(SetMode::Request::PAUSED);
  EXPECT_NE(map_status_.await([](const MapStatus& status) { return status.mode == MapStatus::PAUSED; }),
            nullptr);
  EXPECT_EQ(track(frames[7])->state, TrackerStatus::PAUSED);
  setMode(SetMode::Request::MAPPING);
  const auto again = fuse(frames[8]);
  ASSERT_NE(again, nullptr);
  EXPECT_TRUE(again->fused) << again->reason;
  const Pose T_map_first = fromMessage(poses_.all().front()->pose.pose);
  expectPose(T_map_first.inverse() * fromMessage(poses_.all().back()->pose.pose),
             frames.front().T_W_D->inverse() * *frames[8].T_W_D);

  SetMode wrong;
  wrong.request.mode = 7;
  ASSERT_TRUE(call<SetMode>("tsdf_fusion/set_mode", wrong.request, wrong.response));
  EXPECT_FALSE(wrong.response.success);
}

TEST_F(Live, UnloadsAndReloadsEveryNodelet) {
  loadTracking();
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(24));
  fuseAll({frames.begin(), frames.begin() + 4});
  size_t next = 4;
  for (const std::string nodelet : {"texture_odometry", "icp_tracking", "tsdf_fusion"}) {
    ASSERT_TRUE(graph_.unload(nodelet));
    ASSERT_TRUE(graph_.load(nodelet));
    ASSERT_TRUE(eventually([&] { return map_status_.connected() && tracker_status_.connected(); }));
    ASSERT_TRUE(camera_.awaitSubscribers());
    ros::WallDuration(2.0).sleep();  // until the nodelets have found each other
    // A nodelet that comes anew may need a frame to learn of the others' state.
    size_t fused = 0;
    for (const size_t end = next + 6; next < end; ++next) {
      camera_.publish(frames[next]);
      const auto tracking = tracker_status_.awaitStamp(camera_.headerOf(frames[next]).stamp);
      ASSERT_NE(tracking, nullptr) << nodelet;
      if (tracking->state >= TrackerStatus::LOST) continue;
      const auto status = map_status_.awaitStamp(camera_.headerOf(frames[next]).stamp);
      ASSERT_NE(status, nullptr) << nodelet;
      if (status->fused) ++fused;
    }
    EXPECT_GE(fused, 4u) << nodelet;
  }
}

TEST_F(Live, UnloadsAndReloadsWhileFramesStream) {
  loadTracking();
  RgbdFrame frame = simulatedFrames(smallRoom(1)).front();
  std::atomic<bool> streaming{true};
  std::thread sensor([&] {
    for (; streaming; ros::WallDuration(0.05).sleep()) {
      frame.stamp_s += 0.05;
      camera_.publish(frame);
    }
  });
  const auto fusesFromNowOn = [&] {
    const size_t before = map_status_.count();
    size_t seen = 0;
    return map_status_.await([&](const MapStatus& status) { return ++seen > before && status.fused; }) !=
           nullptr;
  };
  EXPECT_TRUE(fusesFromNowOn());
  for (const std::string nodelet : {"tsdf_fusion", "icp_tracking", "texture_odometry", "tsdf_fusion"}) {
    const std::weak_ptr<SharedMap> map = findMap(graph_.resolve("tsdf_fusion"));
    EXPECT_TRUE(graph_.unload(nodelet));
    if (nodelet == "tsdf_fusion") {
      EXPECT_TRUE(eventually([&] { return map.expired(); })) << "the map has leaked";
    }
    EXPECT_TRUE(graph_.load(nodelet));
    EXPECT_TRUE(fusesFromNowOn()) << nodelet;
  }
  streaming = false;
  sensor.join();
}

}  // namespace
}  // namespace depth_fusion
