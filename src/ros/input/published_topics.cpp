#include "ros/input/published_topics.h"

#include <algorithm>

namespace depth_fusion {

bool PublishedTopics::contains(const std::string& topic) const {
  return std::any_of(topics_.begin(), topics_.end(),
                     [&](const ros::master::TopicInfo& info) { return info.name == topic; });
}

std::string PublishedTopics::namesOf(const std::string& type) const {
  std::string names;
  for (const ros::master::TopicInfo& info : topics_) {
    const bool is_own = info.name.find("/model_view/") != std::string::npos;
    if (info.datatype == type && !is_own) names += (names.empty() ? "" : ", ") + info.name;
  }
  return names.empty() ? "none" : names;
}

}  // namespace depth_fusion
