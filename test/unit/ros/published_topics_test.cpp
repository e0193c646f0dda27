// What is published at the master, if there is one.
#include "ros/input/published_topics.h"

#include <gtest/gtest.h>
#include <ros/init.h>

#include <chrono>
#include <future>
#include <thread>

namespace depth_fusion {
namespace {

TEST(PublishedTopicsTest, AreNoneWithoutAMaster) {
  ros::init(ros::M_string{{"__master", "http://localhost:1"}}, "published_topics_test",
            ros::init_options::NoSigintHandler);
  auto asked = std::make_shared<std::promise<std::string>>();
  std::thread([asked] { asked->set_value(PublishedTopics().namesOf("sensor_msgs/Image")); }).detach();
  auto names = asked->get_future();
  ASSERT_EQ(names.wait_for(std::chrono::seconds(60)), std::future_status::ready) << "it waits for the master";
  EXPECT_EQ(names.get(), "none");
}

TEST(PublishedTopicsTest, AreNamedByTypeWithoutOwnPictures) {
  const PublishedTopics published({{"/a/image", "sensor_msgs/Image"},
                                   {"/tsdf_fusion/model_view/image", "sensor_msgs/Image"},
                                   {"/b/image", "sensor_msgs/Image"},
                                   {"/b/image/compressed", "sensor_msgs/CompressedImage"}});
  EXPECT_EQ(published.namesOf("sensor_msgs/Image"), "/a/image, /b/image");
  EXPECT_TRUE(published.contains("/b/image/compressed"));
  EXPECT_FALSE(published.contains("/b"));
}

}  // namespace
}  // namespace depth_fusion
