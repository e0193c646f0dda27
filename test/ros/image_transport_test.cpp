// Images by image_transport: of transports that plugins bring, and of those that nobody brings.
#include <image_transport/image_transport.h>

#include <cstdlib>

#include "ros/in_process/frames.h"
#include "ros/input/image_topic.h"
#include "ros/input/rgbd_parameters.h"
#include "support/expect_error.h"
#include "support/nodelet_graph.h"
#include "support/other_camera.h"

namespace depth_fusion {
namespace {

// As if the package of the transport "inverted" were installed.
void installInverted() {
  const char* installed = std::getenv("ROS_PACKAGE_PATH");
  const std::string paths = installed == nullptr ? "/usr/share" : installed;
  if (paths.find(TEST_TRANSPORT_FOLDER) == std::string::npos)
    setenv("ROS_PACKAGE_PATH", (TEST_TRANSPORT_FOLDER ":" + paths).c_str(), 1);
}

class ImageTransport : public testing::Test {
 protected:
  ImageTransport()
      : graph_(std::string("transport_") + testing::UnitTest::GetInstance()->current_test_info()->name()),
        frames_(simulatedFrames(smallRoom(1))),
        camera_(graph_.handle()) {
    installInverted();
  }

  // Frames like the first one with later stamps, until one comes through; null if none does.
  SensorFramePtr receiveOne(const image_transport::Publisher* depth,
                            const image_transport::Publisher& color) {
    const Listener<TexturedFrameMessage> textured(graph_.handle(), "texture_odometry/frame");
    RgbdFrame frame = frames_.front();
    for (int i = 0; i < 1000 && textured.count() == 0; ++i) {
      frame.stamp_s += 0.1;
      camera_.publish(frame);
      const std_msgs::Header header = camera_.headerOf(frame);
      if (depth != nullptr) depth->publish(makeDepthImage(header, frame.depth, frame.depth_unit_m));
      color.publish(makeColorImage(header, frame.color));
      ros::WallDuration(0.1).sleep();
    }
    return textured.count() == 0 ? nullptr : textured.all().front()->payload->sensor;
  }

  void expectFrame(const SensorFramePtr& received) const {
    ASSERT_NE(received, nullptr);
    cv::Mat depth, expected;
    received->rgbd.depth.convertTo(depth, CV_32F, received->rgbd.depth_unit_m);
    frames_.front().depth.convertTo(expected, CV_32F, frames_.front().depth_unit_m);
    cv::patchNaNs(depth, 0.0);
    EXPECT_LT(cv::norm(depth, expected, cv::NORM_INF), 1e-6);
    ASSERT_FALSE(received->rgbd.color.empty());
    EXPECT_EQ(cv::norm(received->rgbd.color, frames_.front().color, cv::NORM_INF), 0.0);
  }

  NodeletGraph graph_;
  std::vector<RgbdFrame> frames_;
  FakeCamera camera_;  // whose raw topics nobody listens to where another transport is wanted
};

TEST_F(ImageTransport, AHintIsHonouredWhereAPluginDecodesIt) {
  graph_.handle().setParam("texture_odometry/image_transport", "inverted");
  ASSERT_TRUE(graph_.load("texture_odometry"));
  image_transport::ImageTransport transports(graph_.handle());
  const auto depth = transports.advertise("depth/image", 10), color = transports.advertise("rgb/image", 10);
  expectFrame(receiveOne(&depth, color));
}

TEST_F(ImageTransport, AnImagesOwnTransportGoesFirst) {
  graph_.handle().setParam("texture_odometry/image_transport", "inverted");
  graph_.handle().setParam("texture_odometry/depth_transport", "raw");
  ASSERT_TRUE(graph_.load("texture_odometry"));
  image_transport::ImageTransport transports(graph_.handle());
  const auto color = transports.advertise("rgb/image", 10);
  expectFrame(receiveOne(nullptr, color));
}

TEST_F(ImageTransport, ATransportWithoutAPluginIsAnErrorThatNamesTheOthers) {
  RgbdParameters parameters;
  parameters.depth_transport = "theora";
  expectError(
      [&] { parameters.checkTexts(); },
      {"'theora' of depth/image", "raw, compressedDepth, compressed, points, inverted", "install a plugin"});
  parameters.depth_transport = "inverted";
  EXPECT_NO_THROW(parameters.checkTexts());
  parameters.image_transport = "compressedDepth";
  expectError([&] { parameters.checkTexts(); },
              {"'compressedDepth' of rgb/image", "raw, compressed, inverted"});
  parameters.color_transport = "raw";
  EXPECT_NO_THROW(parameters.checkTexts());
}

TEST_F(ImageTransport, ANodeletDoesNotStartWithATransportThatNothingDecodes) {
  for (const std::string nodelet : {"texture_odometry", "icp_tracking", "tsdf_fusion"}) {
    graph_.handle().setParam(nodelet + "/color_transport", "theora");
    EXPECT_FALSE(graph_.load(nodelet)) << nodelet;
    graph_.handle().setParam(nodelet + "/color_transport", "compressed");
    EXPECT_TRUE(graph_.load(nodelet)) << nodelet;
  }
}

TEST_F(ImageTransport, TwoPublishersByAPluginAreSaid) {
  ImageTopic topic(graph_.handle(), "rgb/image", "inverted", ownColorTransports(),
                   {[](const ImageMessage&) {}, [](uint32_t) {}, [] {}});
  EXPECT_EQ(topic.name(), graph_.resolve("rgb/image/inverted"));
  EXPECT_FALSE(topic.isPublished());
  const auto one = graph_.handle().advertise<sensor_msgs::Image>("rgb/image/inverted", 1);
  EXPECT_TRUE(eventually([&] { return topic.isPublished(); }));
  EXPECT_EQ(topic.problem(), "");
  const OtherCamera other(topic.name());
  EXPECT_TRUE(eventually([&] { return !topic.problem().empty(); }));
  EXPECT_NE(topic.problem().find("two publishers"), std::string::npos) << topic.problem();
}

TEST_F(ImageTransport, TheModelViewIsPublishedByEveryTransport) {
  // A plugin sets parameters of its own, which a nodelet that is loaded again is not to stumble over.
  graph_.handle().setParam("tsdf_fusion/model_view/image/inverted/quality", 80);
  graph_.loadTracking();
  image_transport::ImageTransport transports(graph_.handle());
  const Listener<sensor_msgs::Image> raw(graph_.handle(), "tsdf_fusion/model_view/image");
  std::mutex mutex;
  std::vector<sensor_msgs::ImageConstPtr> decoded;
  const auto subscriber = transports.subscribe(
      "tsdf_fusion/model_view/image", 10,
      [&](const sensor_msgs::ImageConstPtr& image) {
        const std::lock_guard<std::mutex> lock(mutex);
        decoded.push_back(image);
      },
      ros::VoidPtr(), image_transport::TransportHints("inverted"));
  ASSERT_TRUE(camera_.awaitSubscribers());
  ASSERT_TRUE(eventually([&] { return raw.connected() && subscriber.getNumPublishers() > 0; }));
  RgbdFrame frame = frames_.front();
  const auto isSame = [&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return !decoded.empty() && raw.count() > 0 && decoded.back()->data == raw.all().back()->data;
  };
  for (int i = 0; i < 300 && !isSame(); ++i) {
    frame.stamp_s += 0.1;
    camera_.publish(frame);
    ros::WallDuration(0.1).sleep();
  }
  EXPECT_TRUE(isSame());
}

}  // namespace
}  // namespace depth_fusion
