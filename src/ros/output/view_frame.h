// A frame on tf that viewers can follow the camera by.
#pragma once

#include <tf2_ros/transform_broadcaster.h>

#include <optional>
#include <string>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// For one thread.
class ViewFrame {
 public:
  // An empty view_frame is not sent.
  ViewFrame(const std::string& map_frame, const std::string& view_frame)
      : map_frame_(map_frame), view_frame_(view_frame) {}

  // The frame stands where the camera is, level, and looks where the camera looked at first.
  void follow(const ros::Time& stamp, const Pose& T_map_camera);

 private:
  const std::string map_frame_, view_frame_;
  std::optional<double> yaw_rad_;
  tf2_ros::TransformBroadcaster broadcaster_;
};

}  // namespace depth_fusion
