// The submaps as boxes, for who looks at the map in rviz.
#pragma once

#include <ros/node_handle.h>

#include "ros/in_process/shared_map.h"

namespace depth_fusion {

// Publishes `submaps` in the handle's namespace, latched, once a second at most and while somebody looks: a
// box about the blocks of each submap, green where it is active, blue where all of it is in memory, grey
// where a part of it is in the store, and a thin white one about the window. For one thread.
class SubmapMarkers {
 public:
  explicit SubmapMarkers(ros::NodeHandle& handle);

  void publish(const std::string& map_frame, const SubmapCollection& submaps);

 private:
  ros::Publisher publisher_;
  ros::WallTime next_;
  size_t shown_ = 0;  // boxes
};

}  // namespace depth_fusion
