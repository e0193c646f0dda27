#include <fstream>

#include "ros/bags/open_recording.h"
#include "support/bag_fixture.h"
#include "support/expect_error.h"

namespace depth_fusion {
namespace {

namespace fs = std::filesystem;
using BagRecordingTest = BagTest;

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
  // What is wrong with the colour that was asked for costs no depth.
  const std::map<std::string, std::vector<std::string>> faults = {
      {"/right/image", {path, "/right/image", "/left/image [sensor_msgs/Image]"}},
      {kDepthInfo, {path, kDepthInfo, "no topic of images or clouds"}},
      {kDepthTopic, {path, kDepthTopic, "16UC1", "bgr8"}}};
  for (const auto& [topic, words] : faults) {
    options.color_topic = topic;
    const auto recording = openBag(path, options);
    const std::string description = recording->description();
    EXPECT_NE(description.find("colour is left out"), std::string::npos) << description;
    for (const std::string& word : words) EXPECT_NE(description.find(word), std::string::npos) << description;
    const auto depth = recording->next();
    EXPECT_TRUE(sameImage(depth->depth, randomDepth(3)));
    EXPECT_TRUE(depth->color.empty());
  }
}

TEST_F(BagRecordingTest, leaves_out_colour_it_cannot_read_and_says_so) {
  const std::string path = makeBag([](rosbag::Bag& bag) {
    addInfo(bag);
    addDepth(bag, 1.0);
    addToBag(bag, kColorTopic, 1.0, imageMessage(randomColor(1, CV_8UC1), "nv21"));
  });
  const auto recording = openBag(path, {});
  EXPECT_TRUE(recording->next()->color.empty());
  EXPECT_NE(recording->description().find("nv21"), std::string::npos) << recording->description();
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
