// A camera with an inertial sensor and nothing else: its map stands level, and its rotation is a prior.
#include <tf2_ros/static_transform_broadcaster.h>

#include <algorithm>

#include "ros/conversions/imu_conversion.h"
#include "support/live_graph.h"

namespace depth_fusion {
namespace {

constexpr int kFrames = 12, kBegin = 2;
constexpr double kLater_s = 100.0;

class CameraWithImu : public LiveGraph {
 protected:
  CameraWithImu() : imu_(graph_.handle().advertise<sensor_msgs::Imu>("imu", 1000)) {
    SimulationOptions options = smallRoom(kFrames);
    options.robot.has_imu = true;
    frames_ = simulatedFrames(options, kLater_s);
    // The sensor stands aslant on the camera.
    mounting_.sendTransform(
        makeTransform(makeHeader(ros::Time(1.0), "camera_rgb_optical_frame"), "imu_frame", T_D_I_));
  }

  void publishImuUntil(size_t frame) {
    for (; next_ <= frame; ++next_) {
      for (const ImuReading& reading : frames_[next_].readings.imu) {
        const std_msgs::Header header = makeHeader(toRosTime(reading.stamp_s + kLater_s), "imu_frame");
        imu_.publish(makeImu(header, reading, T_D_I_.linear().transpose()));
      }
    }
  }

  const Pose T_D_I_ = motionOf({90.0, 20.0, -30.0}, {0.0, 0.05, 0.0});
  std::vector<RgbdFrame> frames_;
  size_t next_ = 0;
  tf2_ros::StaticTransformBroadcaster mounting_;
  ros::Publisher imu_;
};

TEST_F(CameraWithImu, BeginsLevelAndHasItsRotationAsAPrior) {
  loadTracking();
  ASSERT_TRUE(eventually([&] { return imu_.getNumSubscribers() > 0; }));
  publishImuUntil(kBegin);
  ros::WallDuration(0.5).sleep();  // another connection than the images'
  for (size_t i = kBegin; i < frames_.size(); ++i) {
    publishImuUntil(i);
    ros::WallDuration(0.02).sleep();
    const auto status = fuse(frames_[i]);
    ASSERT_NE(status, nullptr) << i;
    ASSERT_TRUE(status->fused) << i << ": " << status->reason;
  }
  const auto first = poses_.awaitStamp(camera_.headerOf(frames_[kBegin]).stamp);
  ASSERT_NE(first, nullptr);
  const Eigen::Vector3d up_W = fromMessage(first->pose.pose).linear() *
                               frames_[kBegin].T_W_D->linear().transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_GT(up_W.z(), std::cos(0.03));
  const std::vector<std::string> priors = tracker_status_.all().back()->priors;
  EXPECT_EQ(std::count(priors.begin(), priors.end(), "gyroscope"), 1);
}

}  // namespace
}  // namespace depth_fusion
