// A robot's odometry on tf that is late, slow or dead costs no frame, and map -> odom goes on whatever
// happens.
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include <algorithm>

#include "support/diagnostics.h"
#include "support/live_graph.h"

namespace depth_fusion {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr int kFrames = 24;

class OdometryOnTf : public LiveGraph {
 protected:
  OdometryOnTf()
      : name_(testing::UnitTest::GetInstance()->current_test_info()->name()),
        robot_camera_(graph_.handle(), frame("optical")),
        listener_(buffer_),
        transforms_(graph_.handle(), "/tf"),
        frames_(simulatedFrames(smallRoom(kFrames))) {
    graph_.handle().setParam("icp_tracking/map_frame", frame("map"));
    mounting_.sendTransform(
        makeTransform(makeHeader(ros::Time(1.0), frame("base")), frame("optical"), T_base_camera_));
  }

  // Every test has a robot of its own.
  std::string frame(const std::string& name) const { return name_ + "_" + name; }

  Pose T_odom_base(const RgbdFrame& at) const {
    return T_base_camera_ * frames_.front().T_W_D->inverse() * *at.T_W_D * T_base_camera_.inverse();
  }
  void sendOdometry(size_t of) {
    odometry_.sendTransform(
        makeTransform(makeHeader(stamp(of), frame("odom")), frame("base"), T_odom_base(frames_[of])));
  }
  ros::Time stamp(size_t of) const { return robot_camera_.headerOf(frames_[of]).stamp; }

  void startWithOdometry() {
    loadTracking();
    sendOdometry(0);
    ASSERT_TRUE(eventually([&] { return buffer_.canTransform(frame("odom"), frame("optical"), stamp(0)); }));
  }
  void expectFused(size_t i) {
    robot_camera_.publish(frames_[i]);
    const auto status = map_status_.awaitStamp(stamp(i));
    ASSERT_NE(status, nullptr) << i;
    EXPECT_TRUE(status->fused) << i << ": " << status->reason;
  }

  // The stamps with which map -> odom was sent so far.
  std::vector<ros::Time> sent() const {
    std::vector<ros::Time> stamps;
    for (const auto& message : transforms_.all()) {
      for (const auto& transform : message->transforms) {
        if (transform.header.frame_id == frame("map") && transform.child_frame_id == frame("odom"))
          stamps.push_back(transform.header.stamp);
      }
    }
    return stamps;
  }
  void expectMoreOnTf() {
    const size_t before = sent().size();
    EXPECT_TRUE(eventually([&] { return sent().size() >= before + 5; }));
    const std::vector<ros::Time> stamps = sent();
    EXPECT_GT(stamps.back(), stamps[before]) << "time goes on";
  }

  const std::string name_;
  const Pose T_base_camera_ = motionOf({-90.0, 0.0, -90.0}, {0.1, 0.0, 0.4});
  FakeCamera robot_camera_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  Listener<tf2_msgs::TFMessage> transforms_;
  tf2_ros::StaticTransformBroadcaster mounting_;
  tf2_ros::TransformBroadcaster odometry_;
  std::vector<RgbdFrame> frames_;
};

TEST_F(OdometryOnTf, ThatIsLateOrSlowCostsNoFrame) {
  startWithOdometry();
  const Diagnostics diagnostics(graph_.handle());
  constexpr size_t kLate = 5, kEvery = 3;  // frames
  for (size_t i = 0; i < frames_.size(); ++i) {
    expectFused(i);
    if (i >= kLate && (i - kLate) % kEvery == 0) sendOdometry(i - kLate);
  }
  EXPECT_EQ(map_status_.all().back()->frames.processed, uint64_t{kFrames});
  expectMoreOnTf();
  // What the tracker corrects is the error of odometry, which has none here.
  EXPECT_TRUE(eventually([&] {
    sendOdometry(kFrames - 1);
    return fromMessage(buffer_.lookupTransform(frame("map"), frame("odom"), ros::Time(0)).transform)
        .isApprox(Pose::Identity(), 0.01);
  }));
}

TEST_F(OdometryOnTf, IsAPriorAndCarriesThePoseOnWhileTheCameraSeesNothing) {
  startWithOdometry();
  constexpr size_t kBlind = 8, kSeesAgain = 12;
  for (size_t i = 0; i < kBlind; ++i) {
    sendOdometry(i);
    expectFused(i);
  }
  const std::vector<std::string> priors = tracker_status_.awaitStamp(stamp(kBlind - 1))->priors;
  EXPECT_EQ(std::count(priors.begin(), priors.end(), "odometry"), 1);
  double before_m2 = 0.0;
  for (size_t i = kBlind; i < kSeesAgain; ++i) {
    RgbdFrame nothing = frames_[i];
    nothing.depth = cv::Mat::zeros(nothing.depth.size(), nothing.depth.type());
    nothing.color = cv::Mat::zeros(nothing.color.size(), nothing.color.type());
    sendOdometry(i);
    robot_camera_.publish(nothing);
    const auto status = tracker_status_.awaitStamp(stamp(i));
    ASSERT_NE(status, nullptr) << i;
    EXPECT_EQ(status->state, TrackerStatus::PREDICTED) << status->reason;
    EXPECT_NE(status->reason.find("the pose goes on by odometry"), std::string::npos) << status->reason;
    const auto pose = poses_.awaitStamp(stamp(i));
    ASSERT_NE(pose, nullptr) << i;
    expectPose(fromMessage(pose->pose.pose),
               T_base_camera_ * frames_.front().T_W_D->inverse() * *frames_[i].T_W_D, 0.05, 0.05);
    EXPECT_GT(pose->pose.covariance[0], before_m2);
    before_m2 = pose->pose.covariance[0];
  }
  sendOdometry(kSeesAgain);
  expectFused(kSeesAgain);
}

TEST_F(OdometryOnTf, ThatIsDeadIsNamedAndCostsNoFrame) {
  startWithOdometry();
  const Diagnostics diagnostics(graph_.handle());
  for (size_t i = 0; i < frames_.size(); ++i) {
    if (i < 8) sendOdometry(i);
    expectFused(i);
  }
  EXPECT_TRUE(diagnostics.says("icp_tracking", DiagnosticStatus::WARN,
                               "odometry on tf (" + frame("odom") + " -> " + frame("optical")));
  expectMoreOnTf();
  // The robot is where the tracker says, though odometry stands still.
  const Pose T_map_camera = T_base_camera_ * frames_.front().T_W_D->inverse() * *frames_.back().T_W_D;
  EXPECT_TRUE(eventually([&] {
    const Pose found =
        fromMessage(buffer_.lookupTransform(frame("map"), frame("odom"), ros::Time(0)).transform);
    return (found * T_odom_base(frames_[7]) * T_base_camera_).isApprox(T_map_camera, 0.01);
  }));
}

TEST_F(OdometryOnTf, IsCorrectedWhileTheCameraIsSilentAndTheMapPaused) {
  startWithOdometry();
  for (size_t i = 0; i < 4; ++i) {
    sendOdometry(i);
    expectFused(i);
  }
  expectMoreOnTf();
  setMode(SetMode::Request::PAUSED);
  expectMoreOnTf();
}

// Odometry has ROS time, the camera a clock of its own.
class OdometryOfAnotherClock : public OdometryOnTf {
 protected:
  void sendNow(size_t of) {
    odometry_.sendTransform(
        makeTransform(makeHeader(ros::Time::now(), frame("odom")), frame("base"), T_odom_base(frames_[of])));
  }
  // Sends the frames, and expects that map -> odom goes on in ROS time, and that those words are said.
  void expectToBeUsedAndSaid(const std::string& words) {
    const Diagnostics diagnostics(graph_.handle());
    loadTracking();
    sendNow(0);
    ASSERT_TRUE(
        eventually([&] { return buffer_.canTransform(frame("odom"), frame("optical"), ros::Time(0)); }));
    for (size_t i = 0; i < 8; ++i) {
      sendNow(i);
      expectFused(i);
    }
    EXPECT_TRUE(eventually([&] {
      sendNow(7);
      return diagnostics.await("icp_tracking", DiagnosticStatus::WARN, words, 0.2).level >= 0;
    }));
    expectMoreOnTf();
    EXPECT_LT(std::abs(secondsBetween(sent().back(), ros::Time::now())), 60.0);
    // The odometry that was there may have been that of the frame before.
    EXPECT_LT(fromMessage(buffer_.lookupTransform(frame("map"), frame("odom"), ros::Time(0)).transform)
                  .translation()
                  .norm(),
              0.1);
  }
};

TEST_F(OdometryOfAnotherClock, ThatTheCameraIsBehind) { expectToBeUsedAndSaid("s behind ROS time"); }

TEST_F(OdometryOfAnotherClock, ThatTheCameraIsAheadOf) {
  const double later_s = ros::Time::now().toSec() + 600.0 - frames_.front().stamp_s;
  for (RgbdFrame& frame : frames_) frame.stamp_s += later_s;
  expectToBeUsedAndSaid("s ahead of ROS time");
}

TEST_F(OdometryOnTf, ThatNeverComesCostsNoFrameEither) {
  graph_.handle().setParam("icp_tracking/odom_frame", frame("none_such"));
  const Diagnostics diagnostics(graph_.handle());
  loadTracking();
  for (size_t i = 0; i < 4; ++i) expectFused(i);
  EXPECT_TRUE(
      diagnostics.says("icp_tracking", DiagnosticStatus::WARN, "tf does not connect " + frame("none_such")));
}

}  // namespace
}  // namespace depth_fusion
