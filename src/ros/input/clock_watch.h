// Whether ROS time goes on.
#pragma once

#include <ros/time.h>

#include <string>

namespace depth_fusion {

// For one thread, which calls check() at a steady pace.
class ClockWatch {
 public:
  // What is wrong with the clock once it has stood still for some calls because nobody publishes it; empty if
  // nothing is. It is warned of, once, in the name of `who`.
  const std::string& check(const std::string& who);

 private:
  ros::Time last_;  // at the last call
  int still_calls_ = 0;
  std::string problem_;
};

}  // namespace depth_fusion
