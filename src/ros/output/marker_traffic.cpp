#include "ros/output/marker_traffic.h"

#include <ros/topic_manager.h>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace depth_fusion {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;
using visualization_msgs::MarkerArrayPtr;

// Publishes as ros::Publisher does, and returns what expires when no connection holds the message any more.
std::weak_ptr<const void> publishAndFollow(const ros::Publisher& publisher, const MarkerArrayPtr& markers) {
  const auto token = std::make_shared<char>();
  const auto serialize = [&] {
    ros::SerializedMessage message = ros::serialization::serializeMessage(*markers);
    message.buf = boost::shared_array<uint8_t>(message.buf.get(), [own = message.buf, token](uint8_t*) {});
    return message;
  };
  ros::SerializedMessage message;
  message.message = markers;  // for viewers in this process
  message.type_info = &typeid(MarkerArray);
  ros::TopicManager::instance()->publish(publisher.getTopic(), serialize, message);
  return token;
}

MarkerTraffic::Lost contentOf(const MarkerArray& markers) {
  MarkerTraffic::Lost content;
  for (const Marker& marker : markers.markers) {
    content.all_deleted = content.all_deleted || marker.action == Marker::DELETEALL;
    if (marker.action != Marker::DELETEALL) content.ids.push_back(marker.id);
  }
  return content;
}

}  // namespace

MarkerTraffic::Lost MarkerTraffic::publish(const ros::Publisher& publisher, const MarkerArrayPtr& markers) {
  forgetTaken();
  Lost content = contentOf(*markers);
  if (content.all_deleted) {
    for (Sent& sent : sent_) sent.content = {};  // whoever gets this one needs nothing from before
  }
  Lost lost;
  // The oldest one that a viewer has is being written; of those that wait behind it, queue_ are kept.
  for (size_t i = 1; i + queue_ <= sent_.size(); ++i) {
    const Lost dropped = std::exchange(sent_[i].content, {});
    lost.ids.insert(lost.ids.end(), dropped.ids.begin(), dropped.ids.end());
    lost.all_deleted = lost.all_deleted || dropped.all_deleted;
  }
  sent_.push_back({publishAndFollow(publisher, markers), std::move(content)});
  return lost;
}

bool MarkerTraffic::isOver() {
  forgetTaken();
  return sent_.empty();
}

void MarkerTraffic::forgetTaken() {
  sent_.erase(
      std::remove_if(sent_.begin(), sent_.end(), [](const Sent& sent) { return sent.waits.expired(); }),
      sent_.end());
}

}  // namespace depth_fusion
