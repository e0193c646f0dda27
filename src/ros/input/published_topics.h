// What is published at the ROS master, for messages that tell users which topic they may have meant.
#pragma once

#include <ros/master.h>

#include <string>

namespace depth_fusion {

class PublishedTopics {
 public:
  // Asks the master, which may take a moment. None, if it is not there.
  PublishedTopics();
  explicit PublishedTopics(const ros::master::V_TopicInfo& topics) : topics_(topics) {}

  bool contains(const std::string& topic) const;
  // Whether there is a topic of a type that namesOf() names.
  bool hasAny(const std::string& type) const { return namesOf(type) != kNone; }
  // The names of those of a type, as sensor_msgs/Image, for a sentence: "/a, /b" or "none"; this package's
  // own pictures are left out.
  std::string namesOf(const std::string& type) const;

 private:
  static constexpr char kNone[] = "none";

  ros::master::V_TopicInfo topics_;
};

}  // namespace depth_fusion
