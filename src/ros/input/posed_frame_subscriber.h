// Frames from a driver's topics with their poses from tf2, at the images' stamps.
#pragma once

#include <tf2_ros/buffer.h>
#include <tf2_ros/message_filter.h>
#include <tf2_ros/transform_listener.h>

#include <functional>
#include <string>

#include "ros/in_process/deferred.h"
#include "ros/input/rgbd_subscriber.h"

namespace depth_fusion {

class PosedFrameSubscriber {
 public:
  using Callback = std::function<void(const Deferred<TrackedFrame>&)>;

  // The frames are to be decoded while this lives. At most `queue_size` frames wait for their pose; those
  // that find no room are dropped, counted, and warned of.
  PosedFrameSubscriber(ros::NodeHandle handle, const RgbdParameters& rgbd, const std::string& device,
                       const std::string& map_frame, int queue_size, FrameCounter& counter,
                       Callback callback);
  // Waits for what its callbacks are at.
  ~PosedFrameSubscriber();

  void setParameters(const RgbdParameters& rgbd) { sensor_->setParameters(rgbd); }
  // What hinders frames now, for diagnostics; empty if nothing does.
  std::string problem() const;

 private:
  using Message = ProcessMessage<RgbdMessages>;

  TrackedFramePtr decode(const RgbdMessages& messages);
  void drop(const std::string& why);

  std::string map_frame_;
  FrameCounter& counter_;
  Callback callback_;
  mutable std::mutex mutex_;
  std::string problem_;  // of the poses
  tf2_ros::Buffer buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  std::unique_ptr<tf2_ros::MessageFilter<Message>> filter_;
  std::unique_ptr<RgbdSubscriber> sensor_;
};

}  // namespace depth_fusion
