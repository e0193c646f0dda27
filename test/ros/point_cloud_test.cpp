// Clouds in the place of depth images.
#include "ros/input/rgbd_subscriber.h"
#include "support/cloud_messages.h"
#include "support/nodelet_graph.h"

namespace depth_fusion {
namespace {

constexpr char kCameraFrame[] = "camera_rgb_optical_frame";

class PointCloudInput : public testing::Test {
 protected:
  PointCloudInput()
      : graph_(std::string("cloud_") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        frame_(simulatedFrames(smallRoom(1)).front()),
        clouds_(graph_.handle().advertise<sensor_msgs::PointCloud2>("depth/image", 10)),
        info_(graph_.handle().advertise<sensor_msgs::CameraInfo>("depth/camera_info", 10, true)) {
    RgbdParameters parameters;
    parameters.depth_transport = "points";
    subscriber_ = std::make_unique<RgbdSubscriber>(graph_.handle(), parameters, "", counter_,
                                                   [this](const RgbdMessagesPtr& messages) {
                                                     const std::lock_guard<std::mutex> lock(mutex_);
                                                     received_ = messages;
                                                   });
  }

  SensorFramePtr framesOf(const sensor_msgs::PointCloud2Ptr& cloud) {
    EXPECT_TRUE(eventually([&] { return clouds_.getNumSubscribers() > 0; }));
    clouds_.publish(cloud);
    EXPECT_TRUE(eventually([&] {
      const std::lock_guard<std::mutex> lock(mutex_);
      return received_ != nullptr;
    }));
    return subscriber_->decode(*received_);
  }
  std_msgs::Header header() const { return makeHeader(toRosTime(frame_.stamp_s), kCameraFrame); }
  void expectDepth(const SensorFramePtr& frame) const {
    ASSERT_NE(frame, nullptr) << subscriber_->problem();
    cv::Mat depth = frame->rgbd.depth.clone(), expected;
    cv::patchNaNs(depth, 0.0);
    frame_.depth.convertTo(expected, CV_32F, frame_.depth_unit_m);
    EXPECT_LT(cv::norm(depth, expected, cv::NORM_INF), 1e-6);
    EXPECT_NEAR(frame->rgbd.intrinsics.fx, frame_.intrinsics.fx, 0.01);
    EXPECT_EQ(frame->header.frame_id, kCameraFrame);
  }

  NodeletGraph graph_;
  RgbdFrame frame_;
  ros::Publisher clouds_, info_;
  FrameCounter counter_;
  std::mutex mutex_;
  RgbdMessagesPtr received_;
  std::unique_ptr<RgbdSubscriber> subscriber_;
};

TEST_F(PointCloudInput, AnOrganisedCloudNeedsNoCameraInfo) {
  const SensorFramePtr frame = framesOf(cloudOf(header(), frame_));
  expectDepth(frame);
  EXPECT_EQ(cv::norm(frame->rgbd.color, frame_.color, cv::NORM_INF), 0.0);
}

TEST_F(PointCloudInput, AListIsProjectedIntoTheCameraOfTheCameraInfo) {
  info_.publish(makeCameraInfo(header(), frame_.intrinsics));
  expectDepth(framesOf(asList(*cloudOf(header(), frame_))));
}

TEST_F(PointCloudInput, AListWithoutACameraIsRefused) {
  EXPECT_EQ(framesOf(asList(*cloudOf(header(), frame_))), nullptr);
  EXPECT_NE(subscriber_->problem().find("no camera_info"), std::string::npos) << subscriber_->problem();
}

}  // namespace
}  // namespace depth_fusion
