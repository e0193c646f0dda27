// Markers on their way to viewers in other processes.
#pragma once

#include <ros/publisher.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <deque>
#include <memory>
#include <vector>

namespace depth_fusion {

// roscpp keeps some messages for a viewer that is slow, and drops the oldest without a word when there are
// more. This knows which these may have been. For one thread.
class MarkerTraffic {
 public:
  // `queue`: how many messages the publisher keeps for a viewer, as it was advertised.
  explicit MarkerTraffic(size_t queue) : queue_(queue) {}

  // What earlier messages brought, and a viewer may not have got.
  struct Lost {
    std::vector<int> ids;      // of markers, added or deleted
    bool all_deleted = false;  // a DELETEALL was among them
  };
  // Publishes the markers; a DELETEALL stands at the beginning, if at all. Returns what may be dropped for
  // their sake.
  Lost publish(const ros::Publisher& publisher, const visualization_msgs::MarkerArrayPtr& markers);
  // Whether no viewer has still to take any of them.
  bool isOver();

 private:
  struct Sent {
    std::weak_ptr<const void> waits;  // to be taken by a viewer; expired: it no longer does
    Lost content;
  };
  void forgetTaken();

  const size_t queue_;
  std::deque<Sent> sent_;  // and not taken yet by all
};

}  // namespace depth_fusion
