// Where frames are in the map, by tf.
#pragma once

#include <ros/duration.h>
#include <ros/time.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <string>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Listens to tf from when it is first asked on. For one thread at a time.
class MapTransforms {
 public:
  // Maps points of the frame into the map's: the identity for the map's own, and for none. Waits two seconds
  // for tf to tell. A stamp of 0 means the frame's latest place. Throws Error if tf does not tell.
  Pose poseOf(const std::string& frame, const std::string& map_frame, const ros::Time& stamp);

 private:
  std::unique_ptr<tf2_ros::Buffer> tf_;  // null, as is the next, before it is first needed
  std::unique_ptr<tf2_ros::TransformListener> listener_;
};

}  // namespace depth_fusion
