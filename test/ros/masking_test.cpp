// What is left out of depth: people that somebody's detector shows, and the robot's own body.
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <fstream>

#include "ros/input/rgbd_subscriber.h"
#include "ros/input/robot_model.h"
#include "support/expect_error.h"
#include "support/nodelet_graph.h"
#include "support/temporary_folder.h"

namespace depth_fusion {
namespace {

constexpr char kCameraFrame[] = "camera_rgb_optical_frame";

class Masking : public testing::Test {
 protected:
  Masking()
      : graph_(std::string("masking_") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        frames_(simulatedFrames(smallRoom(4))),
        camera_(graph_.handle()) {}

  void subscribe(const MaskingParameters& masking) {
    RgbdParameters parameters;
    parameters.masking = masking;
    subscriber_ = std::make_unique<RgbdSubscriber>(graph_.handle(), parameters, "", counter_,
                                                   [this](const RgbdMessagesPtr& messages) {
                                                     const std::lock_guard<std::mutex> lock(mutex_);
                                                     received_.push_back(messages);
                                                   });
    ASSERT_TRUE(camera_.awaitSubscribers());
  }
  size_t received() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return received_.size();
  }
  bool awaitFrames(size_t count) const {
    return eventually([&] { return received() == count; });
  }
  // How many of the frame's pixels have lost their depth.
  int lost(size_t frame, const SensorFramePtr& decoded) const {
    EXPECT_NE(decoded, nullptr) << subscriber_->problem();
    if (decoded == nullptr) return -1;
    return cv::countNonZero(frames_[frame].depth) - cv::countNonZero(decoded->rgbd.depth);
  }
  std::string dropped() const {
    std::string text;
    const FrameAccount account = counter_.account();
    for (size_t i = 0; i < account.reasons.size(); ++i)
      text += account.reasons[i] + ": " + std::to_string(account.dropped[i]) + "; ";
    return text;
  }

  NodeletGraph graph_;
  std::vector<RgbdFrame> frames_;
  FakeCamera camera_;
  FrameCounter counter_;
  mutable std::mutex mutex_;
  std::vector<RgbdMessagesPtr> received_;
  std::unique_ptr<RgbdSubscriber> subscriber_;
};

TEST_F(Masking, EachFrameWaitsForItsMaskAndGoesNotWithoutOne) {
  ros::Publisher masks = graph_.handle().advertise<sensor_msgs::Image>("mask", 10);
  MaskingParameters masking;
  masking.max_wait_s = 60.0f;
  subscribe(masking);
  ASSERT_TRUE(eventually([&] { return masks.getNumSubscribers() == 1; }));
  const auto publish_mask = [&](size_t frame, int rows) {
    cv::Mat mask(240, 320, CV_8UC1, cv::Scalar(0));
    mask.rowRange(0, rows).setTo(255);
    const std_msgs::Header header = makeHeader(toRosTime(frames_[frame].stamp_s), kCameraFrame);
    masks.publish(makeImage(header, mask, "mono8"));
  };
  camera_.publish(frames_[0]);
  ASSERT_TRUE(eventually([&] { return counter_.account().received == 1; }));
  ros::WallDuration(0.1).sleep();
  EXPECT_EQ(received(), 0u) << "its mask may still come";
  publish_mask(0, 60);
  ASSERT_TRUE(awaitFrames(1));
  camera_.publish(frames_[1]);
  camera_.publish(frames_[2]);
  publish_mask(2, 0);
  ASSERT_TRUE(awaitFrames(2));
  EXPECT_EQ(dropped(), "no mask: 1; ");
  EXPECT_NE(subscriber_->problem().find("mask"), std::string::npos) << subscriber_->problem();
  EXPECT_EQ(received_[1]->header.stamp, toRosTime(frames_[2].stamp_s));
  const SensorFramePtr masked = subscriber_->decode(*received_[0]);
  EXPECT_EQ(lost(0, masked), cv::countNonZero(frames_[0].depth.rowRange(0, 60)));
  EXPECT_EQ(cv::countNonZero(masked->rgbd.depth.rowRange(0, 60)), 0);
  EXPECT_EQ(lost(2, subscriber_->decode(*received_[1])), 0);
  masks.shutdown();
  camera_.publish(frames_[3]);  // the detector has ended: frames are used as they are
  ASSERT_TRUE(awaitFrames(3));
  EXPECT_EQ(lost(3, subscriber_->decode(*received_[2])), 0);
}

TEST_F(Masking, AMaskOfAnotherCameraIsRefused) {
  ros::Publisher masks = graph_.handle().advertise<sensor_msgs::Image>("mask", 10);
  subscribe(MaskingParameters());
  ASSERT_TRUE(eventually([&] { return masks.getNumSubscribers() == 1; }));
  masks.publish(makeImage(makeHeader(toRosTime(frames_[0].stamp_s), "other"),
                          cv::Mat(240, 320, CV_8UC1, cv::Scalar(0)), "mono8"));
  camera_.publish(frames_[0]);
  ASSERT_TRUE(awaitFrames(1));
  EXPECT_EQ(subscriber_->decode(*received_[0]), nullptr);
  EXPECT_NE(subscriber_->problem().find("frame other"), std::string::npos) << subscriber_->problem();
}

// A slab across the view, of which tf tells where it is at each image's stamp.
TEST_F(Masking, TheBodyIsCutOutWhereItIsAtTheImagesStamp) {
  MaskingParameters masking;
  masking.body = "arm box 0 0 0 20 20 0.5";
  masking.max_wait_s = 60.0f;
  subscribe(masking);
  tf2_ros::TransformBroadcaster tf;
  const auto send_arm = [&](double stamp_s, double z_m) {
    Pose T_D_F = Pose::Identity();
    T_D_F.translation().z() = z_m;
    tf.sendTransform(makeTransform(makeHeader(toRosTime(stamp_s), kCameraFrame), "arm", T_D_F));
  };
  const auto deeper = [&](size_t frame, double from_m, double to_m) {
    const cv::Mat& depth = frames_[frame].depth;
    return cv::countNonZero((depth >= 1000.0 * from_m) & (depth <= 1000.0 * to_m));
  };
  camera_.publish(frames_[0]);
  ASSERT_TRUE(eventually([&] { return counter_.account().received == 1; }));
  send_arm(frames_[0].stamp_s - 1.0, 2.0);
  ros::WallDuration(0.1).sleep();
  EXPECT_EQ(received(), 0u) << "where the arm is then is not known yet";
  send_arm(frames_[0].stamp_s + 1.0, 3.0);
  ASSERT_TRUE(awaitFrames(1));
  const int expected = deeper(0, 2.5 - 0.28, 2.5 + 0.28);
  EXPECT_GT(expected, 1000);
  EXPECT_NEAR(lost(0, subscriber_->decode(*received_[0])), expected, 30);  // depth in whole millimetres
  masking.body.clear();
  RgbdParameters without;
  without.masking = masking;
  subscriber_->setParameters(without);
  EXPECT_EQ(lost(0, subscriber_->decode(*received_[0])), 0);
}

TEST_F(Masking, AFrameIsLeftOutIfTfDoesNotKnowTheBody) {
  MaskingParameters masking;
  masking.body = "arm sphere 0 0 0 1";
  masking.max_wait_s = 0.05f;
  subscribe(masking);
  camera_.publish(frames_[0]);
  ASSERT_TRUE(awaitFrames(1));
  EXPECT_EQ(subscriber_->decode(*received_[0]), nullptr);
  EXPECT_NE(subscriber_->problem().find("arm"), std::string::npos) << subscriber_->problem();
}

constexpr char kRobot[] = R"(<robot name="r"><link name="base">
  <visual><geometry><sphere radius="9"/></geometry></visual>
  <collision><origin xyz="0 0 2.5" rpy="0 0 1.5"/><geometry><box size="20 20 0.5"/></geometry></collision>
  <collision><geometry><cylinder radius="0.1" length="0.2"/></geometry></collision></link>
  <link name="tool"><visual><geometry><sphere radius="0.2"/></geometry></visual></link>
  <joint name="j" type="fixed"><parent link="base"/><child link="tool"/></joint></robot>)";

TEST_F(Masking, TheBodyIsThatOfTheUrdfWhenItIsThere) {
  tf2_ros::StaticTransformBroadcaster tf;
  for (const char* link : {"base", "tool"})
    tf.sendTransform(makeTransform(makeHeader(ros::Time::now(), kCameraFrame), link, Pose::Identity()));
  MaskingParameters masking;
  masking.robot_description = "description";
  subscribe(masking);
  camera_.publish(frames_[0]);
  ASSERT_TRUE(awaitFrames(1));
  EXPECT_EQ(subscriber_->decode(*received_[0]), nullptr);
  EXPECT_NE(subscriber_->problem().find("description: nothing is there"), std::string::npos)
      << subscriber_->problem();
  graph_.handle().setParam("description", kRobot);
  SensorFramePtr frame;
  ASSERT_TRUE(eventually([&] { return (frame = subscriber_->decode(*received_[0])) != nullptr; }));
  const cv::Mat& depth = frames_[0].depth;
  EXPECT_NEAR(lost(0, frame), cv::countNonZero((depth >= 2220.0) & (depth <= 2780.0)), 30);
}

TEST(RobotModel, HasTheLinksCollisionGeometryElseTheVisualOne) {
  const std::vector<BodyPart> parts = partsOfRobot(kRobot);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].frame, "base");
  EXPECT_EQ(parts[0].solid.kind, Solid::Kind::kBox);
  EXPECT_TRUE(parts[0].T_F_S.translation().isApprox(Eigen::Vector3d(0.0, 0.0, 2.5)));
  EXPECT_NEAR(rotationAngle(parts[0].T_F_S), 1.5, 1e-6);
  EXPECT_EQ(parts[1].solid.kind, Solid::Kind::kCylinder);
  EXPECT_NEAR(parts[1].solid.half_m.z(), 0.1, 1e-9);
  EXPECT_EQ(parts[2].frame, "tool");
  EXPECT_EQ(parts[2].solid.kind, Solid::Kind::kSphere);
  expectError([] { partsOfRobot("<robot"); }, {"URDF"});
}

TEST(RobotModel, AMeshIsItsBox) {
  const TemporaryFolder folder;
  std::ofstream(folder / "part.stl") << "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 "
                                        "0\nvertex 0 2 4\nendloop\nendfacet\nendsolid a\n";
  const auto robot_of = [&](const std::string& mesh) {
    return R"(<robot name="r"><link name="base"><visual><origin xyz="0 0 1"/><geometry><mesh filename=")" +
           mesh + R"(" scale="0.1 0.1 0.1"/></geometry></visual></link></robot>)";
  };
  const std::vector<BodyPart> parts = partsOfRobot(robot_of("file://" + (folder / "part.stl")));
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_TRUE(parts[0].T_F_S.translation().isApprox(Eigen::Vector3d(0.05, 0.1, 1.2)));
  EXPECT_TRUE(parts[0].solid.half_m.isApprox(Eigen::Vector3d(0.05, 0.1, 0.2)));
  expectError([&] { partsOfRobot(robot_of("file:///none/such.stl")); }, {"such.stl"});
  expectError([&] { partsOfRobot(robot_of("package://none_such_package/a.stl")); }, {"none_such_package"});
}

}  // namespace
}  // namespace depth_fusion
