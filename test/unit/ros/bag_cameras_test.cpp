#include <tf2_msgs/TFMessage.h>

#include "ros/bags/open_recording.h"
#include "ros/conversions/messages.h"
#include "support/bag_fixture.h"
#include "support/expect_error.h"

namespace depth_fusion {
namespace {

using BagCamerasTest = BagTest;

TEST_F(BagCamerasTest, finds_intrinsics_of_the_same_size_nearby) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addToBag(bag, "/camera/depth_registered/image_raw", 1.0, imageMessage(randomDepth(1), "16UC1"));
    addToBag(bag, "/camera/rgb/camera_info", 1.0, infoMessage(640, 480, 525.0));
    addToBag(bag, "/camera/depth/camera_info", 1.0, infoMessage(kTestWidth, kTestHeight, 9.0));
  });
  expectSameIntrinsics(openBag(path, {})->next()->intrinsics, {kTestWidth, kTestHeight, 9.0, 9.0, 5.5, 3.25});
}

TEST_F(BagCamerasTest, uses_the_projection_of_rectified_images) {
  const auto makeWith = [&](const std::string& depth_topic) {
    return makeBag([&](rosbag::Bag& bag) {
      sensor_msgs::CameraInfo info = infoMessage(kTestWidth, kTestHeight, 10.0);
      info.D = {0.1, 0.0, 0.0, 0.0, 0.0};
      addToBag(bag, kDepthInfo, 1.0, info);
      addToBag(bag, depth_topic, 1.0, imageMessage(randomDepth(1), "16UC1"));
    });
  };
  const auto raw = openBag(makeWith("/camera/depth/image_raw"), {})->next();
  EXPECT_EQ(raw->intrinsics.fx, 10.0);
  EXPECT_EQ(raw->distortion, (LensDistortion{0.1, 0.0, 0.0, 0.0, 0.0}));
  const auto rectified = openBag(makeWith("/camera/depth/image_rect"), {})->next();
  EXPECT_EQ(rectified->intrinsics.fx, 11.0);
  EXPECT_TRUE(rectified->distortion.empty());
}

TEST_F(BagCamerasTest, finds_the_colour_camera_by_its_info_and_tf) {
  const Pose T_C_D(Eigen::Translation3d(-0.025, 0.0, 0.0));
  const auto makeWith = [&](const std::string& tf_parent) {
    return makeBag([&](rosbag::Bag& bag) {
      sensor_msgs::CameraInfo info = infoMessage(kTestWidth, kTestHeight, 10.0);
      addToBag(bag, kDepthInfo, 1.0, info);
      info.header.frame_id = "color_frame";
      info.D = {0.1, 0.0, 0.0, 0.0, 0.0};
      addToBag(bag, "/camera/rgb/camera_info", 1.0, info);
      sensor_msgs::Image depth = imageMessage(randomDepth(1), "16UC1");
      depth.header.frame_id = "depth_frame";
      addToBag(bag, "/camera/depth/image_raw", 1.0, depth);
      addToBag(bag, "/camera/rgb/image_raw", 1.0, imageMessage(randomColor(1), "bgr8"));
      tf2_msgs::TFMessage tf;
      tf.transforms.push_back(makeTransform(makeHeader(ros::Time(1.0), tf_parent), "depth_frame", T_C_D));
      bag.write("/tf_static", ros::Time(1.0), tf);
    });
  };
  const auto connected = openRecording(makeWith("color_frame"), {})->next();
  ASSERT_TRUE(connected->T_C_D.has_value());
  EXPECT_TRUE(connected->T_C_D->isApprox(T_C_D));
  EXPECT_EQ(connected->color_distortion, (LensDistortion{0.1, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_TRUE(connected->distortion.empty());
  EXPECT_FALSE(connected->color.empty());
  const auto unconnected = openRecording(makeWith("somewhere"), {});
  EXPECT_TRUE(unconnected->next()->color.empty());
  EXPECT_NE(unconnected->description().find("color_frame"), std::string::npos) << unconnected->description();
}

TEST_F(BagCamerasTest, says_that_a_camera_changes) {
  const auto makeWith = [&](double later_focal_px) {
    return makeBag([&](rosbag::Bag& bag) {
      for (int i = 0; i < 50; ++i) {
        addToBag(bag, kDepthInfo, 1.0 + 0.1 * i,
                 infoMessage(kTestWidth, kTestHeight, i < 30 ? 10.0 : later_focal_px));
        addDepth(bag, 1.0 + 0.1 * i);
      }
    });
  };
  const auto recording = openBag(makeWith(8.5), {});
  EXPECT_NE(recording->description().find("changes, from a focal length of 10 to 8.5"), std::string::npos)
      << recording->description();
  EXPECT_EQ(recording->next()->intrinsics.fx, 10.0);
  EXPECT_EQ(openBag(makeWith(10.0), {})->description().find("changes"), std::string::npos);
}

TEST_F(BagCamerasTest, refuses_lenses_that_cannot_be_taken_out_of_depth) {
  const std::pair<const char*, std::vector<double>> lenses[] = {
      {"thin prism", {0.01, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.001, 0.0, 0.0, 0.0}},
      {"tilt", {0.01, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.01, 0.0}},
      {"folds", {-9.0, 0.0, 0.0, 0.0}},
      {"no number", {std::nan(""), 0.0, 0.0, 0.0}}};
  for (const auto& [word, lens] : lenses) {
    const std::string path = makeBag([&lens = lens](rosbag::Bag& bag) {
      sensor_msgs::CameraInfo info = infoMessage(kTestWidth, kTestHeight, 10.0);
      info.distortion_model = "rational_polynomial";
      info.D = lens;
      addToBag(bag, kDepthInfo, 1.0, info);
      addDepth(bag, 1.0);
    });
    expectError([&] { openBag(path, {}); }, {path, kDepthInfo, word});
  }
}

TEST_F(BagCamerasTest, asks_for_missing_intrinsics_and_takes_given_ones) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addDepth(bag, 1.0);
    addInfo(bag, "/other/camera_info");
  });
  expectError([&] { openBag(path, {}); },
              {path, "no camera_info", "/camera/depth/image_raw [sensor_msgs/Image]",
               "/other/camera_info [sensor_msgs/CameraInfo]", "--intrinsics"});
  RecordingOptions options;
  options.intrinsics = CameraIntrinsics{0, 0, 11.0, 12.0, 6.0, 4.0};
  expectSameIntrinsics(openBag(path, options)->next()->intrinsics,
                       {kTestWidth, kTestHeight, 11.0, 12.0, 6.0, 4.0});
  const std::string uncalibrated = makeBag([](rosbag::Bag& bag) {
    addDepth(bag, 1.0);
    addToBag(bag, kDepthInfo, 1.0, infoMessage(kTestWidth, kTestHeight, 0.0));
  });
  expectError([&] { openBag(uncalibrated, {}); }, {uncalibrated, kDepthInfo, "not valid", "--intrinsics"});
  const std::string other_size = makeBag([](rosbag::Bag& bag) {
    addDepth(bag, 1.0);
    addToBag(bag, kDepthInfo, 1.0, infoMessage(640, 480, 525.0));
  });
  expectError([&] { openBag(other_size, {}); }, {other_size, kDepthInfo, "12x8", "640x480"});
}

}  // namespace
}  // namespace depth_fusion
