#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>

#include <fstream>
#include <functional>

#include "ros/messages.h"
#include "ros/recording.h"
#include "support/bag_messages.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/test_frames.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;

const char kDepthTopic[] = "/camera/depth/image_raw";
const char kDepthInfo[] = "/camera/depth/camera_info";
const char kColorTopic[] = "/camera/rgb/image_raw";

class BagRecordingTest : public ::testing::Test {
 protected:
  std::string makeBag(const std::function<void(rosbag::Bag&)>& fill) {
    const std::string path = folder_ / ("bag" + std::to_string(bag_count_++) + ".bag");
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    fill(bag);
    bag.close();
    return path;
  }

  TemporaryFolder folder_;
  int bag_count_ = 0;
};

void addInfo(rosbag::Bag& bag, const std::string& topic = kDepthInfo) {
  addToBag(bag, topic, 1.0, infoMessage(kTestWidth, kTestHeight, 10.0));
}

void addDepth(rosbag::Bag& bag, double stamp_s, double delay_s = 0.0) {
  addToBag(bag, kDepthTopic, stamp_s, imageMessage(randomDepth(static_cast<int>(stamp_s * 100.0)), "16UC1"),
           delay_s);
}

void addGray(rosbag::Bag& bag, double stamp_s, int gray, double delay_s = 0.0) {
  const cv::Mat color(kTestHeight, kTestWidth, CV_8UC1, cv::Scalar(gray));
  addToBag(bag, kColorTopic, stamp_s, imageMessage(color, "mono8"), delay_s);
}

// The gray value of a frame's colour, or -1 if it has none.
int grayOf(const std::optional<RgbdFrame>& frame) {
  return frame && !frame->color.empty() ? frame->color.at<uint8_t>(0, 0) : -1;
}

TEST_F(BagRecordingTest, reads_compressed_topics) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addToBag(bag, "/camera/depth/image_raw/compressedDepth", 1.0,
             compressedDepthMessage(randomDepth(1), "16UC1; compressedDepth"));
    addToBag(bag, "/camera/rgb/image_raw/compressed", 1.0, compressedMessage(randomColor(1), ".png", "png"));
  });
  const auto frame = openBag(path, {})->next();
  ASSERT_TRUE(frame.has_value());
  EXPECT_TRUE(sameImage(frame->depth, randomDepth(1)));
  EXPECT_TRUE(sameImage(frame->color, randomColor(1)));
}

TEST_F(BagRecordingTest, reads_compressed_chunks_and_other_encodings_in_between) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    bag.setCompression(rosbag::compression::BZ2);
    bag.setChunkThreshold(100);
    addInfo(bag);
    addDepth(bag, 1.0);
    addToBag(bag, kDepthTopic, 1.1, imageMessage(cv::Mat(kTestHeight, kTestWidth, CV_32FC1, 2.5f), "32FC1"));
  });
  const auto recording = openBag(path, {});
  EXPECT_DOUBLE_EQ(recording->next()->depth_unit_m, 0.001);
  const auto frame = recording->next();
  EXPECT_DOUBLE_EQ(frame->depth_unit_m, 1.0);
  EXPECT_EQ(frame->depth.at<float>(3, 3), 2.5f);
}

TEST_F(BagRecordingTest, pairs_each_depth_with_the_nearest_colour) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addGray(bag, 0.985, 10);
    addDepth(bag, 1.0);
    addGray(bag, 1.010, 20);
    addGray(bag, 1.043, 30);
    addDepth(bag, 1.05);
    addDepth(bag, 2.0);
    addGray(bag, 2.021, 40);
    addDepth(bag, 3.0);
  });
  const auto recording = openBag(path, {});
  EXPECT_EQ(grayOf(recording->next()), 20);
  EXPECT_EQ(grayOf(recording->next()), 30);
  EXPECT_EQ(grayOf(recording->next()), -1);
  EXPECT_EQ(grayOf(recording->next()), -1);
  EXPECT_FALSE(recording->next().has_value());
}

TEST_F(BagRecordingTest, waits_for_colour_that_arrives_late) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    for (int i = 0; i < 20; ++i) {
      addDepth(bag, 1.0 + 0.1 * i);
      addGray(bag, 1.0 + 0.1 * i, i + 1, 0.35);
    }
  });
  const auto recording = openBag(path, {});
  for (int i = 0; i < 20; ++i) EXPECT_EQ(grayOf(recording->next()), i + 1);
}

TEST_F(BagRecordingTest, waits_for_depth_that_arrives_late) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    for (int i = 0; i < 20; ++i) {
      addDepth(bag, 1.0 + 0.1 * i, 0.35);
      addGray(bag, 1.0 + 0.1 * i, i + 1);
    }
  });
  const auto recording = openBag(path, {});
  for (int i = 0; i < 20; ++i) EXPECT_EQ(grayOf(recording->next()), i + 1);
}

TEST_F(BagRecordingTest, takes_the_time_of_receipt_for_missing_stamps) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    bag.write(kDepthTopic, ros::Time(5.25), imageMessage(randomDepth(1), "16UC1"));
  });
  EXPECT_EQ(openBag(path, {})->next()->stamp_s, 5.25);
}

TEST_F(BagRecordingTest, leaves_out_images_that_go_back_in_time) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addDepth(bag, 1.0);
    addDepth(bag, 0.9, 0.2);
    addDepth(bag, 1.2);
  });
  const auto recording = openBag(path, {});
  EXPECT_EQ(recording->next()->stamp_s, 1.0);
  expectError([&] { recording->next(); }, {path, kDepthTopic, "not later"});
  EXPECT_EQ(recording->next()->stamp_s, 1.2);
}

TEST_F(BagRecordingTest, goes_on_after_a_bad_message) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addDepth(bag, 1.0);
    addToBag(bag, kDepthTopic, 1.1, imageMessage(randomColor(1), "bgr8"));
    addToBag(bag, kDepthTopic, 1.2, imageMessage(randomDepth(1).rowRange(0, 4), "16UC1"));
    sensor_msgs::Image cut = imageMessage(randomDepth(1), "16UC1");
    cut.data.resize(20);
    addToBag(bag, kDepthTopic, 1.3, cut);
    addDepth(bag, 1.4);
  });
  const auto recording = openBag(path, {});
  EXPECT_EQ(recording->frameCount(), 5u);
  EXPECT_EQ(recording->next()->stamp_s, 1.0);
  expectError([&] { recording->next(); }, {path, kDepthTopic, "bgr8", "16UC1, mono16 and 32FC1"});
  expectError([&] { recording->next(); }, {path, kDepthTopic, "12x4", "12x8"});
  expectError([&] { recording->next(); }, {path, kDepthTopic, "20 bytes"});
  EXPECT_EQ(recording->next()->stamp_s, 1.4);
  EXPECT_FALSE(recording->next().has_value());
}

TEST_F(BagRecordingTest, takes_given_topics) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addInfo(bag, "/range/camera_info");
    addDepth(bag, 1.0);
    addToBag(bag, "/range/image", 1.5, imageMessage(randomDepth(3), "16UC1"));
    addToBag(bag, "/left/image", 1.5, imageMessage(randomColor(3), "bgr8"));
  });
  RecordingOptions options;
  options.depth_topic = "/range/image";
  options.color_topic = "/left/image";
  const auto frame = openBag(path, options)->next();
  EXPECT_EQ(frame->stamp_s, 1.5);
  EXPECT_TRUE(sameImage(frame->depth, randomDepth(3)));
  EXPECT_TRUE(sameImage(frame->color, randomColor(3)));
  options.color_topic = "/right/image";
  expectError([&] { openBag(path, options); }, {path, "/right/image", "/left/image [sensor_msgs/Image]"});
  options.color_topic = kDepthInfo;
  expectError([&] { openBag(path, options); }, {path, kDepthInfo, "no image topic"});
  options.color_topic = kDepthTopic;
  expectError([&] { openBag(path, options); }, {path, kDepthTopic, "16UC1", "bgr8"});
}

TEST_F(BagRecordingTest, leaves_out_colour_it_cannot_read_and_says_so) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addDepth(bag, 1.0);
    addToBag(bag, kColorTopic, 1.0, imageMessage(randomColor(1, CV_8UC1), "bayer_rggb8"));
  });
  const auto recording = openBag(path, {});
  EXPECT_TRUE(recording->next()->color.empty());
  EXPECT_NE(recording->description().find("bayer_rggb8"), std::string::npos) << recording->description();
}

TEST_F(BagRecordingTest, finds_intrinsics_of_the_same_size_nearby) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addToBag(bag, "/camera/depth_registered/image_raw", 1.0, imageMessage(randomDepth(1), "16UC1"));
    addToBag(bag, "/camera/rgb/camera_info", 1.0, infoMessage(640, 480, 525.0));
    addToBag(bag, "/camera/depth/camera_info", 1.0, infoMessage(kTestWidth, kTestHeight, 9.0));
  });
  expectSameIntrinsics(openBag(path, {})->next()->intrinsics, {kTestWidth, kTestHeight, 9.0, 9.0, 5.5, 3.25});
}

TEST_F(BagRecordingTest, uses_the_projection_of_rectified_images) {
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

TEST_F(BagRecordingTest, finds_the_colour_camera_by_its_info_and_tf) {
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

TEST_F(BagRecordingTest, asks_for_missing_intrinsics_and_takes_given_ones) {
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

TEST_F(BagRecordingTest, lists_the_topics_of_a_bag_without_depth) {
  const std::string path = makeBag([](rosbag::Bag& bag) { addGray(bag, 1.0, 5); });
  expectError([&] { openBag(path, {}); },
              {path, "no depth topic", "/camera/rgb/image_raw [sensor_msgs/Image]"});
  expectError([&] { openBag(makeBag([](rosbag::Bag&) {}), {}); }, {"no depth topic", "no topic at all"});
}

TEST_F(BagRecordingTest, names_depth_of_a_wrong_encoding_at_once) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addToBag(bag, kDepthTopic, 1.0, imageMessage(randomColor(1), "bgr8"));
  });
  expectError([&] { openBag(path, {}); }, {path, kDepthTopic, "bgr8", "16UC1, mono16 and 32FC1"});
}

TEST_F(BagRecordingTest, names_files_that_are_no_whole_bag) {
  expectError([&] { openRecording(folder_ / "no.bag", {}); }, {folder_ / "no.bag", "no such bag"});
  std::ofstream(folder_ / "text.bag") << "hello, I am no bag";
  expectError([&] { openRecording(folder_ / "text.bag", {}); }, {folder_ / "text.bag", "no bag"});
  fs::create_directory(folder_ / "folder.bag");
  expectError([&] { openRecording(folder_ / "folder.bag", {}); }, {folder_ / "folder.bag"});
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    for (int i = 0; i < 10; ++i) addDepth(bag, 1.0 + i);
  });
  for (const double fraction : {0.99, 0.5, 0.01}) {
    fs::resize_file(path, static_cast<uintmax_t>(fraction * static_cast<double>(fs::file_size(path))));
    expectError([&] { openRecording(path, {}); }, {path, "rosbag reindex"});
  }
}

TEST_F(BagRecordingTest, names_bags_that_were_never_closed) {
  const std::string path = folder_ / "open.bag";
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  bag.setChunkThreshold(100);
  addInfo(bag);
  for (int i = 0; i < 100; ++i) addDepth(bag, 1.0 + i);
  fs::copy_file(path, folder_ / "copy.bag");
  bag.close();
  expectError([&] { openBag(folder_ / "copy.bag", {}); }, {"copy.bag", "rosbag reindex"});
}

}  // namespace
}  // namespace depth_fusion
