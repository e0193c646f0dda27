// Bags as recorders leave them: RealSense Viewer's, split ones, open ones, with bad beginnings and bad
// colour.
#include <geometry_msgs/Transform.h>
#include <std_msgs/Float32.h>

#include "ros/bags/open_recording.h"
#include "support/bag_fixture.h"
#include "support/expect_error.h"

namespace depth_fusion {
namespace {

using BagLayoutsTest = BagTest;

constexpr char kColorInfo[] = "/camera/rgb/camera_info";

void addColorInfo(rosbag::Bag& bag, const std::function<void(sensor_msgs::CameraInfo&)>& spoil) {
  sensor_msgs::CameraInfo info = infoMessage(kTestWidth, kTestHeight, 11.0);
  spoil(info);
  addToBag(bag, kColorInfo, 1.0, info);
}

TEST_F(BagLayoutsTest, realsense_viewer_is_found_by_looking) {
  const std::string depth = "/device_0/sensor_0/Depth_0", color = "/device_0/sensor_1/Color_0";
  const std::string path = makeBag([&](rosbag::Bag& bag) {
    std_msgs::Float32 unit;
    unit.data = 0.0001f;
    bag.write("/device_0/sensor_0/option/Depth_Units/value", ros::Time(1.0), unit);
    addToBag(bag, depth + "/info/camera_info", 1.0, infoMessage(kTestWidth, kTestHeight, 9.0));
    addToBag(bag, color + "/info/camera_info", 1.0, infoMessage(kTestWidth, kTestHeight, 10.0));
    geometry_msgs::Transform to_stream;
    to_stream.rotation.w = 1.0;
    bag.write(depth + "/tf/0", ros::Time(1.0), to_stream);
    to_stream.translation.x = 0.015;
    bag.write(color + "/tf/0", ros::Time(1.0), to_stream);
    addToBag(bag, "/device_0/sensor_0/Infrared_1/image/data", 1.0,
             imageMessage(randomColor(2, CV_8UC1), "8UC1"));
    addToBag(bag, depth + "/image/data", 1.0, imageMessage(randomDepth(1), "mono16"));
    addToBag(bag, color + "/image/data", 1.0, imageMessage(randomColor(1), "bgr8"));
  });
  const auto frame = openRecording(path, {})->next();
  EXPECT_TRUE(sameImage(frame->depth, randomDepth(1)));
  EXPECT_TRUE(sameImage(frame->color, randomColor(1)));
  EXPECT_DOUBLE_EQ(frame->depth_unit_m, 0.0001);
  ASSERT_TRUE(frame->T_C_D.has_value());
  EXPECT_TRUE(frame->T_C_D->isApprox(Pose(Eigen::Translation3d(0.015, 0.0, 0.0))));
  EXPECT_EQ(frame->intrinsics.fx, 9.0);
  EXPECT_EQ(frame->color_intrinsics->fx, 10.0);
}

TEST_F(BagLayoutsTest, several_bags_are_one_recording) {
  const std::string second = makeBag([](rosbag::Bag& bag) {
    addDepth(bag, 1.2);
    addGray(bag, 1.2, 30);
  });
  const std::string first = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addDepth(bag, 1.0);
    addGray(bag, 1.0, 10);
    addDepth(bag, 1.1);
  });
  const auto recording = openRecordings({second, first}, {});
  EXPECT_EQ(recording->frameCount(), 3u);
  for (const double stamp_s : {1.0, 1.1, 1.2}) {
    const auto frame = recording->next();
    EXPECT_EQ(frame->stamp_s, stamp_s);
    EXPECT_EQ(frame->color.empty(), stamp_s == 1.1);
  }
  EXPECT_FALSE(recording->next().has_value());
  expectError([&] { openRecordings({folder_.path(), first}, {}); }, {folder_.path(), "only bags"});
  expectError([&] { openRecordings({first, folder_ / "none.bag"}, {}); }, {"none.bag", "no such bag"});
}

TEST_F(BagLayoutsTest, a_bag_is_one_whatever_its_name) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addDepth(bag, 1.0);
  });
  std::filesystem::rename(path, folder_ / "run.bag.active");
  EXPECT_EQ(openRecording(folder_ / "run.bag.active", {})->next()->stamp_s, 1.0);
  std::filesystem::resize_file(folder_ / "run.bag.active", 5000);
  expectError([&] { openRecording(folder_ / "run.bag.active", {}); }, {"run.bag.active", "rosbag reindex"});
}

TEST_F(BagLayoutsTest, bad_first_messages_cost_themselves_only) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addToBag(bag, kDepthInfo, 0.5, sensor_msgs::CameraInfo());
    addInfo(bag);
    addToBag(bag, kDepthTopic, 0.7, sensor_msgs::Image());
    addToBag(bag, kDepthTopic, 0.8, imageMessage(randomColor(1), "bgr8"));
    addToBag(bag, kDepthTopic, 0.9, imageMessage(randomDepth(1).rowRange(0, 4), "16UC1"));
    addToBag(bag, kColorTopic, 0.9, sensor_msgs::Image());
    for (int i = 0; i < 3; ++i) {
      addDepth(bag, 1.0 + i);
      addGray(bag, 1.0 + i, 50 + i);
    }
  });
  const auto recording = openRecording(path, {});
  for (const char* word : {"encoding ''", "bgr8", "12x4"})
    expectError([&] { recording->next(); }, {kDepthTopic, word});
  for (int i = 0; i < 3; ++i) {
    const auto frame = recording->next();
    EXPECT_EQ(frame->stamp_s, 1.0 + i);
    EXPECT_EQ(frame->color.at<uint8_t>(0, 0), 50 + i);
  }
}

TEST_F(BagLayoutsTest, whatever_is_wrong_with_the_colour_camera_leaves_colour_out) {
  const std::pair<const char*, std::function<void(sensor_msgs::CameraInfo&)>> faults[] = {
      {"equidistant", [](auto& info) { info.distortion_model = "equidistant"; }},
      {"fisheye",
       [](auto& info) {
         info.distortion_model = "fisheye", info.D = {0.1, 0.0, 0.0, 0.0};
       }},
      {"not 7", [](auto& info) { info.distortion_model = "plumb_bob", info.D.assign(7, 0.1); }},
      {"640x480", [](auto& info) { info.width = 640, info.height = 480; }},
      {"not valid", [](auto& info) { info.K[2] = 100.0, info.P[2] = -5.0; }},
      {"folds",
       [](auto& info) {
         info.distortion_model = "plumb_bob", info.D = {-9.0, 0.0, 0.0, 0.0, 0.0};
       }},
      {"no number", [](auto& info) { info.K[0] = info.P[0] = std::nan(""); }}};
  for (const auto& [word, spoil] : faults) {
    const std::string path = makeBag([&spoil = spoil](rosbag::Bag& bag) {
      addInfo(bag);
      addColorInfo(bag, spoil);
      addDepth(bag, 1.0);
      addGray(bag, 1.0, 50);
    });
    const auto recording = openRecording(path, {});
    EXPECT_NE(recording->description().find("colour is left out"), std::string::npos) << word;
    EXPECT_NE(recording->description().find(word), std::string::npos) << recording->description();
    const auto frame = recording->next();
    EXPECT_FALSE(frame->depth.empty()) << word;
    EXPECT_TRUE(frame->color.empty()) << word;
  }
}

TEST_F(BagLayoutsTest, colour_of_another_clock_is_said) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    for (int i = 0; i < 30; ++i) {
      addGray(bag, 99.0 + 0.1 * i, 50, 1.0);
      addDepth(bag, 100.0 + 0.1 * i);
    }
  });
  const auto recording = openRecording(path, {});
  std::string problem;
  for (int i = 0; i < 30; ++i) {
    const auto frame = recording->next();
    EXPECT_FALSE(frame->depth.empty());
    EXPECT_TRUE(i >= 4 || frame->color_problem.empty()) << i;
    if (!frame->color_problem.empty()) problem = frame->color_problem;
  }
  EXPECT_NE(problem.find("s earlier: let both be stamped by one clock"), std::string::npos) << problem;
}

TEST_F(BagLayoutsTest, several_cameras_are_named) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag, "/a/depth/camera_info");
    addInfo(bag, "/b/depth/camera_info");
    addToBag(bag, "/a/depth/image_raw", 1.0, imageMessage(randomDepth(1), "16UC1"));
    addToBag(bag, "/b/depth/image_raw", 1.0, imageMessage(randomDepth(2), "16UC1"));
  });
  const std::string description = openRecording(path, {})->description();
  EXPECT_NE(description.find("there is more depth: /b/depth/image_raw"), std::string::npos) << description;
  RecordingOptions options;
  options.depth_topic = "/b/depth/image_raw";
  EXPECT_TRUE(sameImage(openRecording(path, options)->next()->depth, randomDepth(2)));
}

TEST_F(BagLayoutsTest, depth_that_says_metres_and_means_millimetres_is_said) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    cv::Mat millimetres;
    randomDepth(1).convertTo(millimetres, CV_32F);
    addToBag(bag, kDepthTopic, 1.0, imageMessage(millimetres, "32FC1"));
  });
  const auto recording = openRecording(path, {});
  EXPECT_NE(recording->description().find("taken for millimetres"), std::string::npos);
  EXPECT_EQ(recording->next()->depth_unit_m, 0.001);
}

TEST_F(BagLayoutsTest, colour_of_many_coefficients_is_used) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addColorInfo(bag, [](auto& info) {
      info.distortion_model = "rational_polynomial";
      info.D.assign(14, 0.001);
    });
    addDepth(bag, 1.0);
    addGray(bag, 1.0, 50);
  });
  const auto frame = openRecording(path, {})->next();
  EXPECT_EQ(frame->color_distortion.size(), 14u);
  EXPECT_FALSE(frame->color.empty());
}

TEST_F(BagLayoutsTest, colour_messages_that_cannot_be_read_cost_no_depth) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addGray(bag, 1.0, 50);
    addDepth(bag, 1.0);
    addToBag(bag, kColorTopic, 1.1, imageMessage(randomColor(1), "nv21"));
    addDepth(bag, 1.1);
    addToBag(bag, kColorTopic, 1.2, sensor_msgs::Image());
    addDepth(bag, 1.2);
  });
  const auto recording = openRecording(path, {});
  EXPECT_FALSE(recording->next()->color.empty());
  for (const char* word : {"nv21", "encoding ''"}) {
    const auto frame = recording->next();
    EXPECT_FALSE(frame->depth.empty());
    EXPECT_NE(frame->color_problem.find(word), std::string::npos) << frame->color_problem;
  }
}

// The stamps of depth and colour jump together, and colour still belongs to its depth.
TEST_F(BagLayoutsTest, a_clock_that_is_set_back_costs_nothing) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    for (int i = 0; i < 20; ++i) {
      const double received_s = 100.0 + 0.1 * i;
      const double off_s = i < 12 ? 0.0 : -50.0;
      addDepth(bag, received_s + off_s, -off_s);
      addGray(bag, received_s + off_s, i + 1, -off_s);
    }
  });
  const auto recording = openRecording(path, {});
  for (int i = 0; i < 20; ++i) {
    const auto frame = recording->next();
    EXPECT_NEAR(frame->stamp_s, 100.0 + 0.1 * i, 1e-6);
    EXPECT_EQ(frame->color.at<uint8_t>(0, 0), i + 1);
    EXPECT_EQ(frame->stamp_problem.empty(), i < 12);
  }
}

TEST_F(BagLayoutsTest, one_image_an_hour_ahead_costs_nothing_that_follows) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    for (int i = 0; i < 10; ++i) {
      const double off_s = i == 3 ? 3600.0 : 0.0;
      addDepth(bag, 100.0 + 0.1 * i + off_s, -off_s);
      addGray(bag, 100.0 + 0.1 * i, i + 1);
    }
  });
  const auto recording = openRecording(path, {});
  for (int i = 0; i < 10; ++i) {
    const auto frame = recording->next();
    EXPECT_NEAR(frame->stamp_s, 100.0 + 0.1 * i, 1e-6);
    EXPECT_EQ(frame->color.empty(), i == 3);
  }
}

}  // namespace
}  // namespace depth_fusion
