#include "ros/input/clock_watch.h"

#include <ros/console.h>

#include <utility>

#include "ros/input/published_topics.h"

namespace depth_fusion {
namespace {

constexpr int kStillCalls = 10;  // before that is a problem: a replay may still be starting

}  // namespace

const std::string& ClockWatch::check(const std::string& who) {
  const ros::Time now = ros::Time::now();
  still_calls_ = now == std::exchange(last_, now) ? still_calls_ + 1 : 0;
  if (still_calls_ == 0) problem_.clear();
  if (still_calls_ < kStillCalls || !problem_.empty()) return problem_;
  if (!ros::Time::isSimTime() || PublishedTopics().contains("/clock")) return problem_;
  problem_ =
      "use_sim_time is set, but nobody publishes /clock, so that time stands still; rosparam set "
      "use_sim_time false, and start the nodelets again";
  ROS_WARN_STREAM(who << ": " << problem_);
  return problem_;
}

}  // namespace depth_fusion
