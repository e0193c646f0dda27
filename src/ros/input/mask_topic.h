// Masks that come on a topic, for the depth images of their stamps.
#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/Image.h>

#include <deque>
#include <mutex>
#include <string>

namespace depth_fusion {

// Subscribes `mask` in the handle's namespace. Thread-safe.
class MaskTopic {
 public:
  explicit MaskTopic(ros::NodeHandle handle);
  // Waits for the callback in progress.
  ~MaskTopic() { subscriber_.shutdown(); }

  std::string name() const { return subscriber_.getTopic(); }
  // Somebody publishes masks: frames are to have one.
  bool isPublished() const { return subscriber_.getNumPublishers() > 0; }
  // The one nearest in time, or null if it is farther off than that.
  sensor_msgs::ImageConstPtr find(const ros::Time& stamp, double max_gap_s) const;
  // One from after the stamp has come, so that none from before will.
  bool isPast(const ros::Time& stamp) const;

 private:
  mutable std::mutex mutex_;
  std::deque<sensor_msgs::ImageConstPtr> masks_;  // the latest, in the order that they came in
  ros::Subscriber subscriber_;
};

}  // namespace depth_fusion
