// A bag opened for reading, with rosbag's exceptions turned into Errors.
#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/common/error.h"
#include "ros/bags/bag_topics.h"

namespace depth_fusion {

// Throws Error for a file that is missing, no bag, unindexed or truncated.
std::unique_ptr<rosbag::Bag> openBagFile(const std::string& path);

// The topics of the bag, sorted by name.
std::vector<BagTopic> topicsOf(const rosbag::Bag& bag);

// The message at a place of the bag. Throws Error naming bag and topic if it cannot be read as a Message.
template <class Message>
boost::shared_ptr<const Message> readMessage(const rosbag::MessageInstance& place, const rosbag::Bag& bag) {
  boost::shared_ptr<const Message> message;
  std::string reason = "it has another definition than this ROS's";
  try {
    message = place.instantiate<Message>();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  check(message != nullptr,
        bag.getFileName() + ": a message of " + place.getTopic() + " cannot be read: " + reason);
  return message;
}

}  // namespace depth_fusion
