// Images as drivers really send them.
#include "ros/in_process/frames.h"
#include "support/bag_messages.h"
#include "support/nodelet_graph.h"

namespace depth_fusion {
namespace {

class Inputs : public testing::Test {
 protected:
  Inputs()
      : graph_(std::string("inputs_") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        frames_(simulatedFrames(smallRoom(4))),
        textured_(graph_.handle(), "texture_odometry/frame") {}

  void load() {
    ASSERT_TRUE(graph_.load("texture_odometry"));
    camera_ = std::make_unique<FakeCamera>(graph_.handle());
    ASSERT_TRUE(camera_->awaitSubscribers());
  }

  // The frame as it came through, or null.
  SensorFramePtr receive(const RgbdFrame& frame, double patience_s = kPatience_s) {
    const auto message = textured_.awaitStamp(toRosTime(frame.stamp_s), patience_s);
    return message == nullptr ? nullptr : message->payload->sensor;
  }

  template <class Message>
  void publish(ros::Publisher& publisher, Message message, const RgbdFrame& frame) {
    message.header = camera_->headerOf(frame);
    publisher.publish(boost::make_shared<Message>(message));
  }

  // The largest difference in metres to the frame's own depth.
  double depthError(const SensorFrame& received, const RgbdFrame& frame) const {
    cv::Mat a, b;
    received.rgbd.depth.convertTo(a, CV_32F, received.rgbd.depth_unit_m);
    frame.depth.convertTo(b, CV_32F, frame.depth_unit_m);
    cv::patchNaNs(a, 0.0);
    return cv::norm(a, b, cv::NORM_INF);
  }

  NodeletGraph graph_;
  std::vector<RgbdFrame> frames_;
  std::unique_ptr<FakeCamera> camera_;
  Listener<TexturedFrameMessage> textured_;
};

TEST_F(Inputs, EveryDepthEncoding) {
  load();
  ros::Publisher depth = graph_.handle().advertise<sensor_msgs::Image>("depth/image", 10);
  cv::Mat metres;
  frames_[2].depth.convertTo(metres, CV_32F, 0.001);
  metres.setTo(std::numeric_limits<float>::quiet_NaN(), frames_[2].depth == 0);
  const std::vector<sensor_msgs::Image> images = {
      imageMessage(frames_[0].depth, "16UC1"), imageMessage(frames_[1].depth, "mono16"),
      imageMessage(metres, "32FC1"), imageMessage(frames_[3].color, "bgr8")};
  for (size_t i = 0; i < 3; ++i) {
    camera_->publish(frames_[0]);  // for its camera_info; out of order from the second on
    publish(depth, images[i], frames_[i]);
    const SensorFramePtr received = receive(frames_[i]);
    ASSERT_NE(received, nullptr) << images[i].encoding;
    EXPECT_LT(depthError(*received, frames_[i]), 1e-6) << images[i].encoding;
  }
  publish(depth, images[3], frames_[3]);
  EXPECT_EQ(receive(frames_[3], 1.0), nullptr) << "colour is no depth";
}

TEST_F(Inputs, CompressedTransportsAreFound) {
  ros::Publisher depth =
      graph_.handle().advertise<sensor_msgs::CompressedImage>("depth/image/compressedDepth", 10);
  ros::Publisher color = graph_.handle().advertise<sensor_msgs::CompressedImage>("rgb/image/compressed", 10);
  ros::Publisher info = graph_.handle().advertise<sensor_msgs::CameraInfo>("depth/camera_info", 10);
  ASSERT_TRUE(graph_.load("texture_odometry"));
  ASSERT_TRUE(eventually([&] {
    return depth.getNumSubscribers() > 0 && color.getNumSubscribers() > 0 && info.getNumSubscribers() > 0;
  }));
  camera_ = std::make_unique<FakeCamera>(graph_.handle());  // for its headers
  info.publish(makeCameraInfo(camera_->headerOf(frames_[0]), frames_[0].intrinsics));
  publish(color, compressedMessage(frames_[0].color, ".png", "bgr8; png compressed bgr8"), frames_[0]);
  publish(depth, compressedDepthMessage(frames_[0].depth, "16UC1; compressedDepth"), frames_[0]);
  const SensorFramePtr received = receive(frames_[0]);
  ASSERT_NE(received, nullptr);
  EXPECT_LT(depthError(*received, frames_[0]), 1e-6);
  EXPECT_EQ(cv::norm(received->rgbd.color, frames_[0].color, cv::NORM_INF), 0.0);
}

TEST_F(Inputs, ColourLaterOrMissing) {
  load();
  camera_->publishDepth(frames_[0]);
  ros::WallDuration(0.03).sleep();
  camera_->publishColor(frames_[0]);
  const SensorFramePtr late = receive(frames_[0]);
  ASSERT_NE(late, nullptr);
  EXPECT_FALSE(late->rgbd.color.empty());

  camera_->publishDepth(frames_[1]);
  const SensorFramePtr without = receive(frames_[1]);
  ASSERT_NE(without, nullptr);
  EXPECT_TRUE(without->rgbd.color.empty());
}

TEST_F(Inputs, CameraInfoLateZeroOrOfAnotherSize) {
  ASSERT_TRUE(graph_.load("texture_odometry"));
  ros::Publisher depth = graph_.handle().advertise<sensor_msgs::Image>("depth/image", 10);
  ros::Publisher info = graph_.handle().advertise<sensor_msgs::CameraInfo>("depth/camera_info", 10);
  ASSERT_TRUE(eventually([&] { return depth.getNumSubscribers() > 0 && info.getNumSubscribers() > 0; }));
  camera_ = std::make_unique<FakeCamera>(graph_.handle());
  const auto publishDepth = [&](const RgbdFrame& frame) {
    publish(depth, imageMessage(frame.depth, "16UC1"), frame);
  };
  const auto publishInfo = [&](const CameraIntrinsics& camera) {
    info.publish(makeCameraInfo(camera_->headerOf(frames_[0]), camera));
  };
  publishDepth(frames_[0]);
  ros::WallDuration(0.1).sleep();
  publishInfo(frames_[0].intrinsics);
  EXPECT_NE(receive(frames_[0]), nullptr) << "camera_info comes a little late";

  publishInfo({});
  ros::WallDuration(0.1).sleep();
  publishDepth(frames_[1]);
  EXPECT_EQ(receive(frames_[1], 1.0), nullptr) << "without a focal length";

  CameraIntrinsics other = frames_[0].intrinsics;
  other.width *= 2;
  publishInfo(other);
  ros::WallDuration(0.1).sleep();
  publishDepth(frames_[2]);
  EXPECT_EQ(receive(frames_[2], 1.0), nullptr) << "of another size";

  publishInfo(frames_[0].intrinsics);
  ros::WallDuration(0.1).sleep();
  publishDepth(frames_[3]);
  EXPECT_NE(receive(frames_[3]), nullptr) << "good again";
}

TEST_F(Inputs, StampsOfZeroGetTheTimeOfArrival) {
  load();
  RgbdFrame frame = frames_[0];
  ros::Publisher depth = graph_.handle().advertise<sensor_msgs::Image>("depth/image", 10);
  camera_->publish(frame);
  ASSERT_NE(receive(frame), nullptr);
  sensor_msgs::Image image = imageMessage(frame.depth, "16UC1");
  const ros::Time before = ros::Time::now();
  depth.publish(boost::make_shared<sensor_msgs::Image>(image));
  const auto message =
      textured_.await([&](const TexturedFrameMessage& received) { return received.header.stamp >= before; });
  ASSERT_NE(message, nullptr);
}

// A map, and a camera whose clock is then set back.
class ClockJumps : public Inputs {
 protected:
  ClockJumps() : map_status_(graph_.handle(), "tsdf_fusion/status") {}

  void mapFrames() {
    graph_.loadTracking();
    camera_ = std::make_unique<FakeCamera>(graph_.handle());
    ASSERT_TRUE(camera_->awaitSubscribers());
    for (const RgbdFrame& frame : frames_) ASSERT_TRUE(send(frame)->fused);
    first_map_ = map_status_.all().back()->generation;
  }
  MapStatus::ConstPtr send(const RgbdFrame& frame, double patience_s = kPatience_s) {
    camera_->publish(frame);
    return map_status_.awaitStamp(toRosTime(frame.stamp_s), patience_s);
  }
  // The bag begins again: one image's stamp is not believed, many are.
  void playAgain() {
    RgbdFrame frame = frames_[0];
    frame.stamp_s -= 50.0;
    for (int i = 0; i < 4; ++i, frame.stamp_s += 0.03) EXPECT_EQ(send(frame, 0.3), nullptr) << i;
    first_believed_ = send(frame);
    ASSERT_NE(first_believed_, nullptr);
    EXPECT_TRUE(first_believed_->fused) << first_believed_->reason;
    for (RgbdFrame later : {frames_[1], frames_[2], frames_[3]}) {
      later.stamp_s -= 49.5;
      const auto status = send(later);
      ASSERT_NE(status, nullptr);
      EXPECT_TRUE(status->fused) << status->reason;
      EXPECT_EQ(status->generation, first_believed_->generation);
    }
  }

  Listener<MapStatus> map_status_;
  uint32_t first_map_ = 0;
  MapStatus::ConstPtr first_believed_;
};

TEST_F(ClockJumps, BeginAnewAndSaySo) {
  mapFrames();
  playAgain();
  EXPECT_NE(first_believed_->generation, first_map_);
  EXPECT_NE(first_believed_->reason.find("the map was emptied"), std::string::npos)
      << first_believed_->reason;
}

TEST_F(ClockJumps, CanKeepTheMap) {
  graph_.handle().setParam("icp_tracking/on_clock_jump", "keep");
  mapFrames();
  playAgain();
  EXPECT_EQ(first_believed_->generation, first_map_);
  EXPECT_EQ(first_believed_->reason, "");
}

TEST_F(ClockJumps, OfOneImageCostThatImage) {
  mapFrames();
  RgbdFrame frame = frames_.back();
  for (const double off_s : {-1.5, -50.0, 5.0, 3600.0}) {
    RgbdFrame wrong = frame;
    wrong.stamp_s += off_s;
    EXPECT_EQ(send(wrong, 0.3), nullptr) << off_s;
    frame.stamp_s += 0.1;
    const auto status = send(frame);
    ASSERT_NE(status, nullptr) << off_s;
    EXPECT_TRUE(status->fused) << status->reason;
    EXPECT_EQ(status->generation, first_map_);
  }
}

TEST(Parameters, UnknownOrWrongOnesStopANodelet) {
  NodeletGraph graph("parameters");
  graph.handle().setParam("icp_tracking/max_rsme_m", 0.1);
  EXPECT_FALSE(graph.load("icp_tracking"));
  graph.handle().deleteParam("icp_tracking/max_rsme_m");
  graph.handle().setParam("icp_tracking/max_rmse_m", -1.0);
  EXPECT_FALSE(graph.load("icp_tracking"));
  graph.handle().setParam("icp_tracking/max_rmse_m", 0.03);
  EXPECT_TRUE(graph.load("icp_tracking"));
}

TEST(TwoCameras, InTwoNamespacesMapEachForItself) {
  NodeletGraph left("left_camera"), right("right_camera");
  right.handle().setParam("icp_tracking/map_frame", "right_map");
  right.handle().setParam("tsdf_fusion/map_frame", "right_map");
  const std::vector<RgbdFrame> frames = simulatedFrames(smallRoom(5));
  Listener<MapStatus> left_status(left.handle(), "tsdf_fusion/status"),
      right_status(right.handle(), "tsdf_fusion/status");
  FakeCamera left_camera(left.handle(), "left_optical"), right_camera(right.handle(), "right_optical");
  left.loadTracking();
  right.loadTracking();
  ASSERT_TRUE(left_camera.awaitSubscribers() && right_camera.awaitSubscribers());
  for (const RgbdFrame& frame : frames) {
    left_camera.publish(frame);
    right_camera.publish(frame);
    const auto l = left_status.awaitStamp(toRosTime(frame.stamp_s)),
               r = right_status.awaitStamp(toRosTime(frame.stamp_s));
    ASSERT_TRUE(l != nullptr && r != nullptr);
    EXPECT_TRUE(l->fused && r->fused);
    EXPECT_NE(l->generation, r->generation);
    EXPECT_EQ(l->blocks, r->blocks);
  }
}

}  // namespace
}  // namespace depth_fusion
