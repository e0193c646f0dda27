// Decides which of a topic's publishers is listened to, and counts its messages that did not come.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <string>

namespace depth_fusion {

// Two publishers on one topic are two cameras, or one camera twice; images of both in turn are of no use. The
// first one is listened to until it has been silent for a second, or is gone. Not thread-safe.
class PublisherWatch {
 public:
  struct Verdict {
    bool is_taken = false;  // else the message is another publisher's
    uint32_t missed = 0;    // messages that were sent before it, and never came
  };

  // Judges the message that arrives next, by its publisher's node, its header's seq, which roscpp counts up
  // at every message that leaves a process, and the number of publishers that the topic has. Steps of seq are
  // losses where most steps are single ones; else the topic is one that topic_tools thins out (throttle,
  // drop), which leave seq as it was.
  Verdict judge(const std::string& publisher, uint32_t seq, uint32_t publishers, const ros::WallTime& now);

  const std::string& publisher() const { return publisher_; }
  // The other publisher, once it has sent a message; empty as long as there is none.
  const std::string& other() const { return other_; }

 private:
  std::string publisher_, other_;
  uint32_t seq_ = 0;
  int single_steps_ = 0;  // of late, more than others
  ros::WallTime last_;
};

}  // namespace depth_fusion
