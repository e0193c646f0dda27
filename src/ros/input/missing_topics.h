// What to tell a user whose images do not come.
#pragma once

#include <string>
#include <vector>

#include "ros/input/published_topics.h"

namespace depth_fusion {

// A topic that is waited for.
struct AwaitedTopic {
  std::string name;
  std::string argument;            // of the launch files, as depth_topic
  std::vector<std::string> types;  // that it may have, as sensor_msgs/Image
};

// Says which of the topics is not published, what is published of their types, and what to do; empty if all
// are published.
std::string missingText(const std::vector<AwaitedTopic>& awaited, const PublishedTopics& published);

}  // namespace depth_fusion
