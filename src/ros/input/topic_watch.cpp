#include "ros/input/topic_watch.h"

#include <ros/console.h>

#include "ros/input/missing_topics.h"

namespace depth_fusion {
namespace {

constexpr double kFresh_s = 1.0;
constexpr double kSilence_s = 2.0;    // without a depth image, before that is a problem
constexpr double kWarnAfter_s = 3.0;  // and before the console says so
constexpr double kStarting_s = 10.0;  // the same where there are no images at all: a driver may be starting
constexpr char kImage[] = "sensor_msgs/Image", kCompressed[] = "sensor_msgs/CompressedImage";

}  // namespace

void TopicWatch::noteDepth() {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_depth_ = ros::WallTime::now();
  has_come_ = true;
}

void TopicWatch::look() {
  const std::string of_publishers = publishers();
  if (said_of_publishers_.isNew(of_publishers)) ROS_WARN_STREAM(of_publishers);
  if (silent_s() < kFresh_s && color_.isPublished() && cameras_.hasDepth()) return;
  const PublishedTopics published;
  depth_.lookAround(published);
  color_.lookAround(published);
  const std::string text = missing(published);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    missing_ = text;
  }
  if (text.empty()) said_of_missing_.forget();
  const bool are_others = published.hasAny(kImage) || published.hasAny(kCompressed);
  if (silent_s() > (are_others ? kWarnAfter_s : kStarting_s) && said_of_missing_.isNew(text))
    ROS_WARN_STREAM(text);
}

std::string TopicWatch::silence() const {
  const double seconds = silent_s();
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string names = missing_.empty() ? "" : "; " + missing_;
  if (!has_come_)
    return "no depth image yet on " + depth_.name() + "; is the sensor running, and is that its topic?" +
           names;
  if (seconds <= kSilence_s) return "";
  return "no depth image on " + depth_.name() + " for " + std::to_string(static_cast<int>(seconds)) +
         " s; is the sensor running?" + names;
}

std::string TopicWatch::publishers() const {
  const std::string of_depth = depth_.problem();
  return of_depth.empty() ? color_.problem() : of_depth;
}

double TopicWatch::silent_s() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return (ros::WallTime::now() - last_depth_).toSec();
}

std::string TopicWatch::missing(const PublishedTopics& published) const {
  return missingText({{depth_.name(), "depth_topic", {kImage, kCompressed}},
                      {cameras_.depthInfoTopic(), "depth_info_topic", {"sensor_msgs/CameraInfo"}}},
                     published);
}

}  // namespace depth_fusion
