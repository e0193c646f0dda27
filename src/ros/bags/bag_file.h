// Bags opened for reading, several as one, with rosbag's exceptions turned into Errors.
#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/common/error.h"
#include "ros/bags/bag_topics.h"

namespace depth_fusion {

// The file begins as bags of ROS 1 do, whatever its name is.
bool isBagFile(const std::string& path);

// The parts of one recording, as `rosbag record --split` writes them. Their messages come in the order of
// receipt.
class BagFiles {
 public:
  // Throws Error for a file that is missing, no bag, unindexed or truncated.
  explicit BagFiles(const std::vector<std::string>& paths);

  // "a.bag", or "a.bag and 2 more", for messages to the user.
  const std::string& name() const { return name_; }
  // Sorted by name.
  const std::vector<BagTopic>& topics() const { return topics_; }
  // The nodes that published the topic.
  std::vector<std::string> publishers(const std::string& topic) const;
  // Adds the topics' messages to the view.
  void addTo(rosbag::View& view, const std::vector<std::string>& topics) const;

 private:
  std::string name_;
  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
  std::vector<BagTopic> topics_;
};

// The message at a place of the bags. Throws Error naming bag and topic if it cannot be read as a Message.
template <class Message>
boost::shared_ptr<const Message> readMessage(const rosbag::MessageInstance& place, const BagFiles& bags) {
  boost::shared_ptr<const Message> message;
  std::string reason = "it has another definition than this ROS's";
  try {
    message = place.instantiate<Message>();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  check(message != nullptr,
        bags.name() + ": a message of " + place.getTopic() + " cannot be read: " + reason);
  return message;
}

}  // namespace depth_fusion
