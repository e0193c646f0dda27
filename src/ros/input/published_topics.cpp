#include "ros/input/published_topics.h"

#include <ros/this_node.h>

#include <algorithm>

namespace depth_fusion {

// As ros::master::getTopics does it, which waits for the master for ever.
PublishedTopics::PublishedTopics() {
  XmlRpc::XmlRpcValue request, response, topics;
  request[0] = ros::this_node::getName();
  request[1] = std::string();
  if (!ros::master::execute("getPublishedTopics", request, response, topics, false)) return;
  for (int i = 0; i < topics.size(); ++i)
    topics_.emplace_back(std::string(topics[i][0]), std::string(topics[i][1]));
}

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
  return names.empty() ? kNone : names;
}

}  // namespace depth_fusion
