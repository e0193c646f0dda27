// Poses as messages and over tf, poses from elsewhere, and the way back to where the sensor has been.
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include "ros/output/camera_tree.h"
#include "support/live_graph.h"

namespace depth_fusion {
namespace {

using LivePoses = LiveGraph;

TEST_F(LivePoses, PosesGoOutAsMessagesAndOverTf) {
  graph_.handle().setParam("icp_tracking/map_frame", "map_poses");
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  Listener<nav_msgs::Odometry> odometry(graph_.handle(), "icp_tracking/odometry");
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
  expectPose(fromMessage(transform.transform), fromMessage(pose->pose.pose), 1e-9, 1e-7);

  // Level at the start: the optical axis is x of the map, and y points down.
  const Pose T_map_first = fromMessage(poses_.all().front()->pose.pose);
  EXPECT_TRUE((T_map_first.linear() * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX(), 1e-9));
  EXPECT_TRUE((T_map_first.linear() * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitZ(), 1e-9));
  const Pose motion = frames.front().T_W_D->inverse() * *frames.back().T_W_D;
  expectPose(T_map_first.inverse() * fromMessage(pose->pose.pose), motion);
  ASSERT_TRUE(odometry.awaitCount(frames.size() - 1));
  const nav_msgs::Odometry& last = *odometry.all().back();
  EXPECT_EQ(last.child_frame_id, "camera_rgb_optical_frame");
  expectPose(fromMessage(last.pose.pose), motion);
  EXPECT_GT(last.pose.covariance[0], 0.0);
  ASSERT_TRUE(eventually([&] { return buffer.canTransform("map_poses", last.header.frame_id, stamp); }));
  expectPose(fromMessage(buffer.lookupTransform("map_poses", last.header.frame_id, stamp).transform) *
                 fromMessage(last.pose.pose),
             fromMessage(pose->pose.pose), 1e-9, 1e-7);
  Listener<nav_msgs::Path> path(graph_.handle(), "icp_tracking/path");  // late
  ASSERT_TRUE(path.awaitCount(1));
  EXPECT_EQ(path.all().back()->header.frame_id, "map_poses");
}

TEST_F(LivePoses, WithOdometryTfIsMapToOdom) {
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
TEST_F(LivePoses, TheFirstFrameWaitsForATreeOnTfThatComesLate) {
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
  expectPose(fromMessage(poses_.all().front()->pose.pose), T_base_camera, 1e-9, 1e-7);
}

TEST_F(LivePoses, ATreeThatGrowsLaterIsFollowed) {
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
               fromMessage(pose->pose.pose) * T_link_camera.inverse(), 1e-9, 1e-7);
  }
  EXPECT_TRUE(followed);
}

// tf had names with a slash before them, and old bags and drivers have them still.
TEST_F(LivePoses, NamesOfFramesMayBeginWithASlash) {
  graph_.handle().setParam("icp_tracking/map_frame", "map_slash");
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  ros::Publisher tf = graph_.handle().advertise<tf2_msgs::TFMessage>("/tf", 10);
  FakeCamera camera(graph_.handle(), "/slash_optical");
  loadTracking();
  const Pose T_base_camera = motionOf({-90.0, 0.0, -90.0}, {0.1, 0.0, 0.4});
  for (const RgbdFrame& frame : simulatedFrames(smallRoom(4))) {
    const ros::Time stamp = camera.headerOf(frame).stamp;
    tf2_msgs::TFMessage message;
    message.transforms = {makeTransform(makeHeader(stamp, "/slash_base"), "/slash_optical", T_base_camera)};
    tf.publish(message);
    ASSERT_TRUE(eventually([&] { return buffer.canTransform("slash_base", "slash_optical", stamp); }));
    camera.publish(frame);
    const auto status = map_status_.awaitStamp(stamp);
    ASSERT_NE(status, nullptr);
    EXPECT_TRUE(status->fused) << status->reason;
    ASSERT_TRUE(eventually([&] { return buffer.canTransform("map_slash", "slash_base", stamp); }));
    EXPECT_EQ(poses_.awaitStamp(stamp)->header.frame_id, "map_slash");
  }
}

TEST(CameraTrees, ForgetNothingForTwoCallbacksAtOnce) {
  constexpr int kMany = 3000;
  NodeletGraph graph("camera_tree");  // for its spinner's threads
  const CameraTree tree(graph.handle(), "map");
  ros::Publisher moving = graph.handle().advertise<tf2_msgs::TFMessage>("/tf", kMany + 1);
  ros::Publisher fixed = graph.handle().advertise<tf2_msgs::TFMessage>("/tf_static", kMany + 1);
  const auto send = [](const ros::Publisher& publisher, const std::string& parent, const std::string& child) {
    tf2_msgs::TFMessage message;
    message.transforms = {makeTransform(makeHeader(ros::Time(1.0), parent), child, Pose::Identity())};
    publisher.publish(message);
  };
  const auto knows = [&](const std::string& parent, const std::string& child) {
    return tree.newest(parent, child).has_value();
  };
  ASSERT_TRUE(eventually([&] {
    send(moving, "tree_base", "tree_camera");
    return knows("tree_base", "tree_camera");
  }));
  for (int i = 0; i < kMany; ++i) {
    send(moving, "tree_a", "tree_b");
    send(fixed, "tree_c", "tree_d");
  }
  send(moving, "tree_a", "last_moving");
  send(fixed, "tree_c", "last_fixed");
  ASSERT_TRUE(eventually([&] { return knows("tree_a", "last_moving") && knows("tree_c", "last_fixed"); }));
  EXPECT_TRUE(knows("tree_base", "tree_camera"));
}

TEST_F(LivePoses, FusesAtPosesFromTf) {
  graph_.handle().setParam("tsdf_fusion/tracking", "external");
  graph_.handle().setParam("tsdf_fusion/map_frame", "map_external");
  graph_.handle().setParam("tsdf_fusion/tf_queue_size", 3);
  graph_.handle().setParam("tsdf_fusion/queue_size", 10);
  graph_.handle().setParam("tsdf_fusion/view_frame", "external_view");
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
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
  EXPECT_TRUE(eventually([&] { return buffer.canTransform("map_external", "external_view", ros::Time(0)); }));
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

// Far from where it was last, with nothing but keyframes to say where that is.
class Keyframes : public LiveGraph {
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

}  // namespace
}  // namespace depth_fusion
