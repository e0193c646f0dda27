// The graph of nodelets as a robot uses it: zero copies, services, resets, poses from elsewhere, tf.
#include <depth_fusion/SetMode.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include <thread>

#include "ros/nodelets/frames.h"
#include "ros/nodelets/shared_map.h"
#include "support/nodelet_graph.h"

namespace depth_fusion {
namespace {

Pose poseOf(const geometry_msgs::Pose& message) {
  geometry_msgs::Transform transform;
  transform.translation.x = message.position.x;
  transform.translation.y = message.position.y;
  transform.translation.z = message.position.z;
  transform.rotation = message.orientation;
  return fromMessage(transform);
}

// Distance in metres, and angle in radians, between where the sensor is thought to be and where it is.
void expectPose(const Pose& found, const Pose& expected, double metres = 0.01, double radians = 0.0087) {
  const Pose error = expected.inverse() * found;
  EXPECT_LT(error.translation().norm(), metres);
  EXPECT_LT(rotationAngle(error), radians);
}

class Live : public testing::Test {
 protected:
  Live()
      : graph_(std::string("live_") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        camera_(graph_.handle()),
        map_status_(graph_.handle(), "tsdf_fusion/status"),
        tracker_status_(graph_.handle(), "icp_tracking/status"),
        poses_(graph_.handle(), "icp_tracking/pose") {}

  void loadTracking() {
    graph_.loadTracking();
    awaitTracking();
  }

  // All that frames pass are connected.
  void awaitTracking() {
    ASSERT_TRUE(camera_.awaitSubscribers());
    ASSERT_TRUE(map_status_.connected() && tracker_status_.connected());
  }

  // Publishes the frame; what became of it, once it is known.
  MapStatus::ConstPtr fuse(const RgbdFrame& frame) {
    camera_.publish(frame);
    return map_status_.awaitStamp(camera_.headerOf(frame).stamp);
  }
  TrackerStatus::ConstPtr track(const RgbdFrame& frame) {
    camera_.publish(frame);
    return tracker_status_.awaitStamp(camera_.headerOf(frame).stamp);
  }
  void fuseAll(const std::vector<RgbdFrame>& frames) {
    for (const RgbdFrame& frame : frames) {
      const auto status = fuse(frame);
      ASSERT_NE(status, nullptr) << "no answer for " << frame.stamp_s;
      ASSERT_TRUE(status->fused) << status->reason;
    }
  }

  template <class Service>
  bool call(const std::string& name, typename Service::Request& request,
            typename Service::Response& response) {
    ros::ServiceClient client = graph_.handle().serviceClient<Service>(name);
    return client.waitForExistence(ros::Duration(kPatience_s)) && client.call(request, response);
  }
  void setMode(uint8_t mode) {
    SetMode service;
    service.request.mode = mode;
    ASSERT_TRUE(call<SetMode>("tsdf_fusion/set_mode", service.request, service.response));
    ASSERT_TRUE(service.response.success) << service.response.message;
  }

  NodeletGraph graph_;
  FakeCamera camera_;
  Listener<MapStatus> map_status_;
  Listener<TrackerStatus> tracker_status_;
  Listener<geometry_msgs::PoseWithCovarianceStamped> poses_;
};

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

TEST_F(Live, PosesGoOutAsMessagesAndOverTf) {
  graph_.handle().setParam("icp_tracking/map_frame", "map_poses");
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  Listener<nav_msgs::Odometry> odometry(graph_.handle(), "texture_odometry/odometry");
  Listener<nav_msgs::Path> path(graph_.handle(), "icp_tracking/path");
  loadTracking();
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(25));
  fuseAll(frames);
  const ros::Time stamp = camera_.headerOf(frames.back()).stamp;
  const auto pose = poses_.awaitStamp(stamp);
  ASSERT_NE(pose, nullptr);
  EXPECT_EQ(pose->header.frame_id, "map_poses");
  EXPECT_GT(pose->pose.covariance[0], 0.0);

  ASSERT_TRUE(
      eventually([&] { return buffer.canTransform("map_poses", "camera_rgb_optical_frame", stamp); }));
  const auto transform = buffer.lookupTransform("map_poses", "camera_rgb_optical_frame", stamp);
  expectPose(fromMessage(transform.transform), poseOf(pose->pose.pose), 1e-9, 1e-7);

  // Level at the start: the optical axis is x of the map, and y points down.
  const Pose T_map_first = poseOf(poses_.all().front()->pose.pose);
  EXPECT_TRUE((T_map_first.linear() * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
  EXPECT_TRUE((T_map_first.linear() * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitZ(), 1e-9));
  const Pose motion = frames.front().T_W_D->inverse() * *frames.back().T_W_D;
  expectPose(T_map_first.inverse() * poseOf(pose->pose.pose), motion);
  ASSERT_TRUE(odometry.awaitCount(frames.size() - 1));
  expectPose(poseOf(odometry.all().back()->pose.pose), motion, 0.05, 0.03);
  ASSERT_TRUE(path.awaitCount(1));
  EXPECT_EQ(path.all().back()->header.frame_id, "map_poses");
}

TEST_F(Live, WithOdometryTfIsMapToOdom) {
  graph_.handle().setParam("icp_tracking/map_frame", "map_robot");
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  tf2_ros::StaticTransformBroadcaster mounting;
  tf2_ros::TransformBroadcaster odometry;
  Pose T_base_camera = motionOf({-90.0, 0.0, -90.0}, {0.1, 0.0, 0.4});
  mounting.sendTransform(
      makeTransform(makeHeader(ros::Time(1.0), "base_link"), "robot_optical", T_base_camera));
  const FakeCamera unused(graph_.handle());
  FakeCamera camera(graph_.handle(), "robot_optical");
  loadTracking();
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(12));
  // Wheel odometry that is off by 2 %.
  const auto T_odom_base = [&](const RgbdFrame& frame) {
    Pose motion = frames.front().T_W_D->inverse() * *frame.T_W_D;
    motion.translation() *= 1.02;
    return Pose(T_base_camera * motion * T_base_camera.inverse());
  };
  for (const RgbdFrame& frame : frames) {
    const std_msgs::Header header = camera.headerOf(frame);
    odometry.sendTransform(makeTransform(makeHeader(header.stamp, "odom"), "base_link", T_odom_base(frame)));
    ASSERT_TRUE(eventually([&] { return buffer.canTransform("odom", "robot_optical", header.stamp); }));
    camera.publish(frame);
    ASSERT_NE(map_status_.awaitStamp(header.stamp), nullptr);
  }
  const ros::Time stamp = camera.headerOf(frames.back()).stamp;
  std::string parent;
  ASSERT_TRUE(eventually([&] { return buffer.canTransform("map_robot", "odom", stamp); }));
  ASSERT_TRUE(buffer._getParent("odom", ros::Time(0), parent));
  EXPECT_EQ(parent, "map_robot");
  ASSERT_TRUE(buffer._getParent("robot_optical", ros::Time(0), parent));
  EXPECT_EQ(parent, "base_link");
  // The first frame puts odom at the map's origin; later map -> odom takes out what odometry is off by.
  const Pose motion = frames.front().T_W_D->inverse() * *frames.back().T_W_D;
  expectPose(fromMessage(buffer.lookupTransform("map_robot", "robot_optical", stamp).transform),
             T_base_camera * motion);
}

// The camera's place on the robot becomes known after the first image only.
TEST_F(Live, TheFirstFrameWaitsForATreeOnTfThatComesLate) {
  graph_.handle().setParam("icp_tracking/map_frame", "map_late");
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  tf2_ros::StaticTransformBroadcaster mounting;
  FakeCamera camera(graph_.handle(), "late_optical");
  loadTracking();
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(3));
  camera.publish(frames[0]);
  ros::WallDuration(0.1).sleep();
  const Pose T_base_camera = motionOf({-90.0, 0.0, -90.0}, {0.1, 0.0, 0.4});
  mounting.sendTransform(
      makeTransform(makeHeader(ros::Time(1.0), "late_base"), "late_optical", T_base_camera));
  for (const RgbdFrame& frame : frames) {
    if (&frame != &frames[0]) camera.publish(frame);
    ASSERT_NE(map_status_.awaitStamp(camera.headerOf(frame).stamp), nullptr);
  }
  const ros::Time stamp = camera.headerOf(frames.back()).stamp;
  ASSERT_TRUE(eventually([&] { return buffer.canTransform("map_late", "late_optical", stamp); }));
  std::string parent;
  ASSERT_TRUE(buffer._getParent("late_optical", ros::Time(0), parent));
  EXPECT_EQ(parent, "late_base");
  ASSERT_TRUE(buffer._getParent("late_base", ros::Time(0), parent));
  EXPECT_EQ(parent, "map_late");
  // The robot's frame stands at the map's origin in the first frame.
  expectPose(poseOf(poses_.all().front()->pose.pose), T_base_camera, 1e-9, 1e-7);
}

TEST_F(Live, ATreeThatGrowsLaterIsFollowed) {
  graph_.handle().setParam("icp_tracking/map_frame", "map_growing");
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  FakeCamera camera(graph_.handle(), "growing_optical");
  loadTracking();
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(12));
  const auto fuseNext = [&](const RgbdFrame& frame) {
    camera.publish(frame);
    const auto status = map_status_.awaitStamp(camera.headerOf(frame).stamp);
    ASSERT_TRUE(status != nullptr && status->fused);
  };
  for (size_t i = 0; i < 3; ++i) fuseNext(frames[i]);
  ASSERT_TRUE(eventually([&] {
    return buffer.canTransform("map_growing", "growing_optical", camera.headerOf(frames[2]).stamp);
  }));
  const Pose T_link_camera = motionOf({-90.0, 0.0, -90.0}, {0.1, 0.0, 0.4});
  tf2_ros::TransformBroadcaster link;
  bool followed = false;
  for (size_t i = 3; i < frames.size() && !followed; ++i) {
    const std_msgs::Header header = camera.headerOf(frames[i]);
    link.sendTransform(
        makeTransform(makeHeader(header.stamp, "growing_link"), "growing_optical", T_link_camera));
    ASSERT_TRUE(
        eventually([&] { return buffer.canTransform("growing_link", "growing_optical", header.stamp); }));
    fuseNext(frames[i]);
    ros::WallDuration(0.1).sleep();
    if (!buffer.canTransform("map_growing", "growing_link", header.stamp)) continue;
    followed = true;
    const auto pose = poses_.awaitStamp(header.stamp);
    ASSERT_NE(pose, nullptr);
    expectPose(fromMessage(buffer.lookupTransform("map_growing", "growing_link", header.stamp).transform),
               poseOf(pose->pose.pose) * T_link_camera.inverse(), 1e-9, 1e-7);
  }
  EXPECT_TRUE(followed);
}

TEST_F(Live, FusesAtPosesFromTf) {
  graph_.handle().setParam("tsdf_fusion/tracking", "external");
  graph_.handle().setParam("tsdf_fusion/map_frame", "map_external");
  graph_.handle().setParam("tsdf_fusion/tf_queue_size", 3);
  graph_.handle().setParam("tsdf_fusion/queue_size", 10);
  tf2_ros::TransformBroadcaster localisation;
  ASSERT_TRUE(graph_.load("tsdf_fusion"));
  ASSERT_TRUE(camera_.awaitSubscribers());
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(12));
  const auto sendPose = [&](const RgbdFrame& frame) {
    localisation.sendTransform(makeTransform(makeHeader(camera_.headerOf(frame).stamp, "map_external"),
                                             "camera_rgb_optical_frame", *frame.T_W_D));
  };
  // The pose may come before the image or after it.
  for (size_t i = 0; i < 6; ++i) {
    if (i % 2 == 0) sendPose(frames[i]);
    camera_.publish(frames[i]);
    ros::WallDuration(0.05).sleep();
    if (i % 2 == 1) sendPose(frames[i]);
    const auto status = map_status_.awaitStamp(camera_.headerOf(frames[i]).stamp);
    ASSERT_NE(status, nullptr);
    EXPECT_TRUE(status->fused) << status->reason;
  }
  // Frames without a pose are never fused at another one's: those that find no room in the queue are dropped
  // and counted. The others get theirs once tf knows the poses before and after them.
  for (size_t i = 6; i < 11; ++i) camera_.publish(frames[i]);
  ros::WallDuration(0.5).sleep();
  sendPose(frames[11]);
  const auto last = fuse(frames[11]);
  ASSERT_NE(last, nullptr);
  EXPECT_TRUE(last->fused) << last->reason;
  EXPECT_EQ(last->frames.received, 12u);
  uint64_t dropped = 0;
  for (size_t i = 0; i < last->frames.reasons.size(); ++i) {
    EXPECT_EQ(last->frames.reasons[i], "no pose on tf");
    dropped += last->frames.dropped[i];
  }
  EXPECT_GE(dropped, 2u);
}

TEST_F(Live, AResetEmptiesMapAndTracker) {
  Listener<TrackedFrameMessage> tracked(graph_.handle(), "icp_tracking/frame");
  loadTracking();
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(12));
  fuseAll({frames.begin(), frames.begin() + 6});
  const uint32_t before = map_status_.all().back()->generation;
  std_srvs::Trigger reset;
  ASSERT_TRUE(call<std_srvs::Trigger>("tsdf_fusion/reset_volume", reset.request, reset.response));
  EXPECT_TRUE(reset.response.success);
  EXPECT_EQ(findMap(graph_.resolve("tsdf_fusion"))->map.usage().blocks, 0u);
  ros::WallDuration(0.5).sleep();  // until the tracker has heard of it: what comes sooner is from before

  fuseAll({frames.begin() + 6, frames.end()});
  const MapStatus after = *map_status_.all().back();
  EXPECT_NE(after.generation, before);
  EXPECT_EQ(after.frames.processed, 12u);
  // The first frame after it begins a map of its own.
  const auto first = tracked.awaitStamp(camera_.headerOf(frames[6]).stamp);
  EXPECT_TRUE(poseOf(poses_.awaitStamp(first->header.stamp)->pose.pose).translation().isZero());
}

class Resets : public Live {
 protected:
  // A map of three frames, and the fourth as tracked in it.
  void mapSomeFrames() {
    loadTracking();
    late_ = graph_.handle().advertise<TrackedFrameMessage>("icp_tracking/frame", 1);
    const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(4));
    fuseAll({frames.begin(), frames.begin() + 3});
    const Listener<TrackedFrameMessage> tracked(graph_.handle(), "icp_tracking/frame");
    fuseAll({frames.back()});
    frame_ = *tracked.awaitStamp(camera_.headerOf(frames.back()).stamp)->payload;
  }
  void reset() {
    std_srvs::Trigger service;
    ASSERT_TRUE(call<std_srvs::Trigger>("tsdf_fusion/reset_volume", service.request, service.response));
  }
  // The frame once more, with a stamp of its own, as it is on its way when the map is reset.
  ros::Time send(ros::WallTime received, bool begins_map) {
    auto sensor = std::make_shared<SensorFrame>(*frame_.sensor);
    sensor->header.stamp += ros::Duration(++sent_);
    sensor->received = received;
    auto frame = std::make_shared<TrackedFrame>(frame_);
    frame->sensor = sensor;
    frame->begins_map = begins_map;
    late_.publish(makeMessage<TrackedFrame>(sensor->header, frame));
    return sensor->header.stamp;
  }
  void expectRefused(const ros::Time& stamp) {
    const auto status = map_status_.awaitStamp(stamp);
    ASSERT_NE(status, nullptr);
    EXPECT_FALSE(status->fused);
    EXPECT_EQ(status->reason, kBeforeReset);
    EXPECT_EQ(status->blocks, 0u);
  }

  ros::Publisher late_;
  TrackedFrame frame_;
  int sent_ = 0;
};

TEST_F(Resets, RefuseFramesFromBefore) {
  mapSomeFrames();
  reset();
  const uint32_t of_old_map = frame_.map_generation;
  const uint32_t of_new_map = findMap(graph_.resolve("tsdf_fusion"))->generation;
  ASSERT_NE(of_old_map, of_new_map);
  for (const bool begins_map : {false, true}) {
    for (const uint32_t generation : {of_old_map, of_new_map, 0u}) {
      frame_.map_generation = generation;
      expectRefused(send(frame_.sensor->received, begins_map));
    }
    // Tracked in the map that is gone, or by one who has not heard of it.
    for (const uint32_t generation : {of_old_map, 0u}) {
      frame_.map_generation = generation;
      expectRefused(send(ros::WallTime::now(), begins_map));
    }
  }
}

// Frames and reset wait for the map at the same time; whoever comes first, nothing is left of the frames.
TEST_F(Resets, LeaveNothingOfFramesThatWaitForTheMap) {
  mapSomeFrames();
  const std::shared_ptr<SharedMap> map = findMap(graph_.resolve("tsdf_fusion"));
  for (int round = 0; round < 5; ++round) {
    frame_.map_generation = map->generation;
    std::unique_lock<std::mutex> busy(map->mutex);
    const ros::Time stamp = send(ros::WallTime::now(), true);
    ros::WallDuration(0.1).sleep();
    std::thread resetting([this] { reset(); });
    ros::WallDuration(0.1).sleep();
    busy.unlock();
    resetting.join();
    ASSERT_NE(map_status_.awaitStamp(stamp), nullptr);
    const std::lock_guard<std::mutex> lock(map->mutex);
    EXPECT_EQ(map->map.usage().blocks, 0u) << round;
  }
}

TEST(MapResets, GoByArrivalAndForAShortTimeByStamps) {
  const MapReset reset{ros::WallTime(100.0), ros::Time(50.0)};
  const auto isBefore = [&](double received_s, double stamp_s) {
    SensorFrame frame;
    frame.received = ros::WallTime(received_s);
    frame.header.stamp = ros::Time(stamp_s);
    return reset.isAfter(frame);
  };
  EXPECT_TRUE(isBefore(99.9, 60.0));
  EXPECT_TRUE(isBefore(100.1, 49.9)) << "was on its way";
  EXPECT_FALSE(isBefore(100.1, 50.1));
  EXPECT_FALSE(isBefore(100.1, 1000.0)) << "stamps of another clock";
  EXPECT_FALSE(isBefore(100.1, 1.0)) << "stamps of another clock";
  EXPECT_FALSE(isBefore(102.0, 49.9)) << "a bag in a loop";
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

// Far from where it was last, with nothing but keyframes to say where that is.
class Keyframes : public Live {
 protected:
  TrackerStatus::ConstPtr jumpBack() {
    loadTracking();
    SimulationOptions options = smallRoom(60);
    options.speed = 2.0;
    std::vector<RgbdFrame> frames = simulatedFrames(options);
    fuseAll(frames);
    RgbdFrame back = frames[2];
    back.stamp_s = frames.back().stamp_s + 1.0;
    return track(back);
  }
};

TEST_F(Keyframes, FindTheSensor) {
  const auto status = jumpBack();
  ASSERT_NE(status, nullptr);
  EXPECT_EQ(status->state, TrackerStatus::TRACKING) << status->reason;
}

TEST_F(Keyframes, AreMatchedWithTheParametersOfTextureOdometry) {
  graph_.handle().setParam("texture_odometry/max_descriptor_distance", 0);
  const auto status = jumpBack();
  ASSERT_NE(status, nullptr);
  EXPECT_EQ(status->state, TrackerStatus::LOST) << "no two descriptors are the same";
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
  EXPECT_EQ(track(frames[6])->state, TrackerStatus::TRACKING);

  setMode(SetMode::Request::PAUSED);
  EXPECT_EQ(track(frames[7])->state, TrackerStatus::PAUSED);
  setMode(SetMode::Request::MAPPING);
  const auto again = fuse(frames[8]);
  ASSERT_NE(again, nullptr);
  EXPECT_TRUE(again->fused) << again->reason;
  const Pose T_map_first = poseOf(poses_.all().front()->pose.pose);
  expectPose(T_map_first.inverse() * poseOf(poses_.all().back()->pose.pose),
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

}  // namespace
}  // namespace depth_fusion
