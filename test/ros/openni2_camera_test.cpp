// What acquisition publishes of a camera through OpenNI2 itself, and what it says of one that it cannot have.
#include <dynamic_reconfigure/Reconfigure.h>
#include <sensor_msgs/SetCameraInfo.h>

#include <cstring>

#include "support/openni2_graph.h"

namespace depth_fusion {
namespace {

using sensor_msgs::CameraInfo;
using sensor_msgs::Image;
using OpenNi2Camera = OpenNi2;

TEST_F(OpenNi2Camera, WithoutRegistrationDepthHasItsOwnFrameAndAWarning) {
  device_.control.registers = false;
  device_.apply();
  Listener<Image> depth(graph_.handle(), "depth/image"), color(graph_.handle(), "rgb/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(says(DiagnosticStatus::WARN, "cannot register depth to colour"));
  ASSERT_TRUE(depth.awaitCount(1) && color.awaitCount(1));
  EXPECT_EQ(depth.all()[0]->header.frame_id, "camera_depth_optical_frame");
  EXPECT_EQ(color.all()[0]->header.frame_id, "camera_rgb_optical_frame");
}

TEST_F(OpenNi2Camera, AModeThatItLacksIsSaidUntilItHasIt) {
  device_.control.refuses_modes = true;
  device_.apply();
  Listener<Image> depth(graph_.handle(), "depth/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(says(DiagnosticStatus::ERROR, "refuses depth_mode 320x240@30"));
  EXPECT_EQ(depth.count(), 0u);
  device_.control.refuses_modes = false;
  device_.apply();
  EXPECT_TRUE(depth.awaitCount(1));
}

TEST_F(OpenNi2Camera, WithoutACameraItSaysWhatItLookedForAndWaits) {
  device_.control.plugged = false;
  device_.apply();
  set("device_id", std::string(kFirstSerial));
  Listener<Image> depth(graph_.handle(), "depth/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(says(DiagnosticStatus::ERROR, std::string("no camera ") + kFirstSerial));
  device_.control.plugged = true;
  device_.apply();
  EXPECT_TRUE(depth.awaitCount(1));
}

TEST_F(OpenNi2Camera, PublishesTheMemoryThatTheDriverWroteTo) {
  device_.control.writes_addresses = true;
  device_.apply();
  set("ir_mode", device_.mode());
  Listener<Image> depth(graph_.handle(), "depth/image"), color(graph_.handle(), "rgb/image"),
      ir(graph_.handle(), "ir/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  for (Listener<Image>* images : {&depth, &color, &ir}) {
    ASSERT_TRUE(images->awaitCount(5));
    for (const auto& image : images->all()) {
      const void* address = nullptr;
      std::memcpy(&address, image->data.data(), sizeof(address));
      EXPECT_EQ(address, image->data.data());
    }
  }
}

TEST_F(OpenNi2Camera, StampsGoByTheCamerasClock) {
  device_.control.fps = 20.0;
  device_.apply();
  set("depth_time_offset", 0.5);
  set("color_time_offset", 0.0);
  Listener<Image> depth(graph_.handle(), "depth/image"), color(graph_.handle(), "rgb/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(depth.awaitCount(41) && color.awaitCount(41));
  EXPECT_LT(depth.all()[40]->header.stamp.toSec(), ros::Time::now().toSec() + 0.5);
  int regular = 0, paired = 0;
  for (size_t i = 0; i < 40; ++i) {
    const double stamp_s = depth.all()[i]->header.stamp.toSec(),
                 next_s = depth.all()[i + 1]->header.stamp.toSec();
    const double periods = (next_s - stamp_s) / 0.05;
    regular += std::abs(periods - std::round(periods)) < 0.02 ? 1 : 0;
    for (const auto& image : color.all())
      paired += std::abs(image->header.stamp.toSec() + 0.5 - stamp_s) < 0.001 ? 1 : 0;
  }
  EXPECT_GE(regular, 30) << "whatever the delays of this machine";
  EXPECT_GE(paired, 30);
}

TEST_F(OpenNi2Camera, CameraInfoIsTheCalibrationOrTheFieldOfView) {
  const TemporaryFolder folder;
  CameraInfo calibration = makeCameraInfo({}, roomFrames().front().intrinsics);
  calibration.D = {0.1, 0.0, 0.0, 0.0, 0.0};
  set("depth_registration", false);
  set("rgb_camera_info_url", "file://" + folder.path() + "/rgb.yaml");
  Listener<CameraInfo> depth(graph_.handle(), "depth/camera_info"), color(graph_.handle(), "rgb/camera_info");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(depth.awaitCount(1) && color.awaitCount(1));
  for (const auto& info : {depth.all()[0], color.all()[0]}) {
    EXPECT_NEAR(info->K[0], 262.5, 1e-3);
    EXPECT_NEAR(info->K[5], 119.5, 1e-9);
    EXPECT_EQ(info->D[0], 0.0);
  }
  ros::ServiceClient client =
      graph_.handle().serviceClient<sensor_msgs::SetCameraInfo>("rgb/set_camera_info");
  sensor_msgs::SetCameraInfo request;
  request.request.camera_info = calibration;
  ASSERT_TRUE(client.call(request));
  ASSERT_TRUE(request.response.success) << request.response.status_message;
  EXPECT_NE(color.await([](const CameraInfo& info) { return info.D[0] == 0.1; }), nullptr);
  EXPECT_TRUE(std::ifstream(folder / "rgb.yaml").good()) << "kept";
}

TEST_F(OpenNi2Camera, ExposureChangesWhileItRuns) {
  Listener<Image> color(graph_.handle(), "rgb/image");
  ASSERT_TRUE(graph_.load("acquisition"));
  ASSERT_TRUE(color.awaitCount(1));
  EXPECT_EQ(device_.settings(), "1 1 0 0");
  dynamic_reconfigure::Reconfigure change;
  change.request.config.bools.resize(1);
  change.request.config.bools[0].name = "auto_exposure";
  change.request.config.ints.resize(1);
  change.request.config.ints[0].name = "exposure";
  change.request.config.ints[0].value = 40;
  ASSERT_TRUE(graph_.handle()
                  .serviceClient<dynamic_reconfigure::Reconfigure>("acquisition/set_parameters")
                  .call(change));
  EXPECT_TRUE(eventually([&] { return device_.settings() == "0 1 40 0"; }));
}

TEST_F(OpenNi2Camera, ARecordingOrACameraButNotBoth) {
  set("recording", std::string("room.bag"));
  EXPECT_FALSE(graph_.load("acquisition"));
}

}  // namespace
}  // namespace depth_fusion
