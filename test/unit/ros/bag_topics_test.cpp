#include "ros/bags/bag_topics.h"

#include <gtest/gtest.h>

namespace depth_fusion {
namespace {

BagTopic image(const std::string& name) { return {name, kImageType}; }
BagTopic compressed(const std::string& name) { return {name, kCompressedImageType}; }
BagTopic info(const std::string& name) { return {name, kCameraInfoType}; }

std::string depthOf(const std::vector<BagTopic>& topics) {
  const auto topic = findDepthTopic(topics);
  return topic ? topic->name : "none";
}

std::string colorOf(const std::vector<BagTopic>& topics, const std::string& depth_topic) {
  const auto topic = findColorTopic(topics, depth_topic);
  return topic ? topic->name : "none";
}

TEST(BagTopics, prefers_registered_raw_depth) {
  EXPECT_EQ(depthOf({image("/camera/depth/image_raw"),
                     compressed("/camera/depth_registered/image_raw/compressedDepth"),
                     image("/camera/depth_registered/image"), image("/camera/depth_registered/image_raw"),
                     image("/camera/depth_registered/image_rect")}),
            "/camera/depth_registered/image_raw");
  EXPECT_EQ(
      depthOf({image("/camera/depth/image_rect_raw"), image("/camera/aligned_depth_to_color/image_raw")}),
      "/camera/aligned_depth_to_color/image_raw");
}

TEST(BagTopics, finds_the_depth_of_known_drivers) {
  EXPECT_EQ(depthOf({image("/camera/rgb/image_color"), image("/camera/depth/image")}), "/camera/depth/image");
  EXPECT_EQ(depthOf({image("/kinect2/qhd/image_color_rect"), image("/kinect2/qhd/image_depth_rect")}),
            "/kinect2/qhd/image_depth_rect");
  EXPECT_EQ(depthOf({compressed("/camera/depth/image_raw/compressedDepth")}),
            "/camera/depth/image_raw/compressedDepth");
}

// It may be a PNG of 16 bits, or a picture.
TEST(BagTopics, depth_compressed_as_a_picture_comes_last) {
  const BagTopic picture = compressed("/camera/depth_registered/image_raw/compressed");
  EXPECT_EQ(depthOf({picture}), picture.name);
  EXPECT_EQ(depthOf({picture, compressed("/camera/depth/image_raw/compressedDepth")}),
            "/camera/depth/image_raw/compressedDepth");
  EXPECT_EQ(depthOf({picture, image("/camera/depth/image_rect")}), "/camera/depth/image_rect");
}

TEST(BagTopics, knows_the_depth_of_other_cameras) {
  const std::vector<BagTopic> topics = {image("/front/depth/image_raw"), image("/front/depth/image_rect"),
                                        compressed("/front/depth/image_raw/compressedDepth"),
                                        image("/rear/depth/image_raw"), image("/rear/rgb/image_raw")};
  EXPECT_EQ(depthOf(topics), "/front/depth/image_raw");
  EXPECT_EQ(rivalsOf(topics[0], topics), std::vector<std::string>{"/rear/depth/image_raw"});
  EXPECT_TRUE(rivalsOf(topics[1], topics).empty());
}

TEST(BagTopics, takes_nothing_else_for_depth) {
  EXPECT_EQ(depthOf({image("/camera/depth/disparity"), image("/camera/ir/depth_like"),
                     image("/camera/rgb/image_raw"), image("/camera/depth/infra1/image_rect_raw"),
                     image("/camera/depth/confidence")}),
            "none");
  EXPECT_EQ(depthOf({image("/first/depth/image")}), "/first/depth/image")
      << "'ir' counts as a whole word only";
}

TEST(BagTopics, takes_clouds_where_there_are_no_images_of_depth) {
  const BagTopic cloud = {"/camera/points", "sensor_msgs/PointCloud2"};
  EXPECT_EQ(depthOf({image("/camera/rgb/image_raw"), cloud}), cloud.name);
  EXPECT_EQ(depthOf({cloud, compressed("/camera/depth/image_raw/compressed")}),
            "/camera/depth/image_raw/compressed");
}

TEST(BagTopics, finds_the_colour_beside_the_depth) {
  const std::vector<BagTopic> topics = {
      image("/a/rgb/image_raw"), compressed("/b/rgb/image_raw/compressed"), image("/b/rgb/image_mono"),
      image("/b/rgb/image_raw"), image("/b/depth_to_rgb/image_raw"),        image("/b/ir/image_raw")};
  EXPECT_EQ(colorOf(topics, "/b/depth/image_raw"), "/b/rgb/image_raw");
  EXPECT_EQ(colorOf({compressed("/camera/color/image_raw/compressed")}, "/camera/depth/image_raw"),
            "/camera/color/image_raw/compressed");
  EXPECT_EQ(colorOf({image("/camera/left/image_raw")}, "/camera/depth/image_raw"), "none");
}

TEST(BagTopics, finds_the_intrinsics_beside_the_depth) {
  const std::vector<BagTopic> topics = {info("/camera/depth/camera_info"), info("/camera/rgb/camera_info"),
                                        info("/other/depth/camera_info"),
                                        image("/camera/depth_registered/camera_info")};
  EXPECT_EQ(ownInfoTopic(topics, "/camera/depth/image_raw"), "/camera/depth/camera_info");
  EXPECT_EQ(ownInfoTopic(topics, "/camera/depth/image_raw/compressedDepth"), "/camera/depth/camera_info");
  EXPECT_EQ(ownInfoTopic(topics, "/camera/depth_registered/image_raw"), "");
  EXPECT_EQ(relatedInfoTopics(topics, "/camera/depth_registered/image_raw"),
            (std::vector<std::string>{"/camera/rgb/camera_info", "/camera/depth/camera_info"}));
  EXPECT_EQ(relatedInfoTopics(topics, "/camera/range/image_raw"),
            (std::vector<std::string>{"/camera/depth/camera_info", "/camera/rgb/camera_info"}));
}

TEST(BagTopics, lists_names_and_types) {
  EXPECT_EQ(listTopics({image("/a"), info("/b")}), "/a [sensor_msgs/Image], /b [sensor_msgs/CameraInfo]");
  EXPECT_EQ(listTopics({}), "no topic at all");
}

}  // namespace
}  // namespace depth_fusion
