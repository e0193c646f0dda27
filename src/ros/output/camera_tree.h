// The tree on tf that the camera stands in, without what the tracker itself adds to it.
#pragma once

#include <ros/node_handle.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <mutex>
#include <optional>
#include <string>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

// Thread-safe. Nothing but awaitGrown() waits.
class CameraTree {
 public:
  CameraTree(ros::NodeHandle handle, const std::string& map_frame);

  // From now on map_frame -> `child` is the tracker's own, and not part of the tree.
  void leaveOut(const std::string& child);

  struct Root {
    std::string frame;
    bool in_map = false;  // somebody else publishes map_frame -> it

    bool operator==(const Root& other) const { return frame == other.frame && in_map == other.in_map; }
  };
  // Returns the top of what is known of the tree now, below map_frame.
  Root rootOf(const std::string& camera_frame) const;
  // Waits until the tree no longer grows. Where somebody publishes on tf, that is when no frame was new for a
  // second; a camera that stands alone waits as long for company, and odometry at the top (REP 105) ends the
  // waiting. It waits three seconds at most.
  void awaitGrown(const std::string& camera_frame) const;

  // T_frame_camera, and of when it is.
  struct Placed {
    Pose T_frame_camera;
    ros::Time stamp;  // zero: for all times
  };
  // Returns the newest that tf knows; none if it does not connect the two.
  std::optional<Placed> newest(const std::string& frame, const std::string& camera_frame) const;
  // Returns T_frame_camera at the image's stamp; none if tf does not know it (yet).
  std::optional<Pose> cameraIn(const std::string& frame, const std_msgs::Header& camera) const;

 private:
  void receive(const tf2_msgs::TFMessage& message, bool is_static);
  bool othersPublish() const;
  ros::WallTime grown() const;
  std::optional<Placed> lookUp(const std::string& frame, const std::string& camera_frame,
                               const ros::Time& stamp) const;

  const std::string map_frame_;
  tf2::BufferCore buffer_;
  mutable std::mutex mutex_;  // of the three that follow
  std::string left_out_;
  ros::Time last_received_;
  ros::WallTime grown_ = ros::WallTime::now();      // when a frame was heard of for the first time
  ros::Subscriber subscriber_, static_subscriber_;  // last: their callbacks use the others
};

}  // namespace depth_fusion
