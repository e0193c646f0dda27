// Whether images come on their topics and, if they do not, which topics may be meant.
#pragma once

#include <ros/time.h>

#include <mutex>
#include <string>

#include "ros/input/image_topic.h"
#include "ros/input/said_once.h"
#include "ros/input/sensor_cameras.h"

namespace depth_fusion {

// Thread-safe, but for look(), which is for one thread.
class TopicWatch {
 public:
  // Keeps references, which need not be used before look().
  TopicWatch(ImageTopic& depth, ImageTopic& color, const SensorCameras& cameras)
      : depth_(depth), color_(color), cameras_(cameras) {}

  // A depth image has come.
  void noteDepth();
  // Looks for topics that are published under other names or transports. The console is told of those that
  // are waited for, and of two publishers on one topic. To be called once a second.
  void look();

  // Says that depth does not come, and what there is instead; empty if it comes.
  std::string silence() const;
  // Says which two nodes publish a topic; empty if none has two.
  std::string publishers() const;

 private:
  double silent_s() const;
  std::string missing(const PublishedTopics& published) const;

  ImageTopic &depth_, &color_;
  const SensorCameras& cameras_;
  SaidOnce said_of_publishers_, said_of_missing_;

  mutable std::mutex mutex_;                         // of what follows
  bool has_come_ = false;                            // a depth image
  ros::WallTime last_depth_ = ros::WallTime::now();  // when it came; at first, when waiting began
  std::string missing_;                              // which topics are not there, and which are
};

}  // namespace depth_fusion
