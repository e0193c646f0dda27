#include "ros/input/image_topic.h"

#include <ros/message_event.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "ros/input/published_topics.h"

namespace depth_fusion {
namespace {

// Callbacks only hand messages on, to a queue of two or so whose losses are counted, so that this one is
// always nearly empty; within a process roscpp would drop from it without a trace.
constexpr uint32_t kTopicQueue = 10;

ImageMessage asImage(const sensor_msgs::ImageConstPtr& message) { return {message, nullptr}; }
ImageMessage asImage(const sensor_msgs::CompressedImageConstPtr& message) { return {nullptr, message}; }

std::vector<std::string> transportsOf(const std::string& transport,
                                      const std::vector<std::string>& compressed) {
  if (transport != kAutoTransport) return {transport};
  std::vector<std::string> transports = {kRawTransport};
  transports.insert(transports.end(), compressed.begin(), compressed.end());
  return transports;
}

}  // namespace

ImageTopic::ImageTopic(const ros::NodeHandle& handle, const std::string& image, const std::string& transport,
                       const std::vector<std::string>& compressed, const Callbacks& callbacks)
    : handle_(handle),
      base_name_(handle_.resolveName(image)),
      transports_(transportsOf(transport, compressed)),
      callbacks_(callbacks) {
  subscribe(transports_.front());
}

void ImageTopic::lookAround(const PublishedTopics& published) {
  if (transports_.size() == 1) return;
  const auto found = std::find_if(transports_.begin(), transports_.end(), [&](const std::string& transport) {
    return published.contains(nameWith(transport));
  });
  const bool is_other = !isPublished() && found != transports_.end() && nameWith(*found) != name();
  const std::string before = std::exchange(found_, is_other ? *found : "");
  if (!is_other || before != *found) return;
  ROS_INFO("%s is not published, %s is, and is taken", name().c_str(), nameWith(*found).c_str());
  subscribe(*found);
}

void ImageTopic::subscribe(const std::string& transport) {
  const std::string name = nameWith(transport);
  const auto subscribed = [&](auto type) {
    using Message = decltype(type);
    const boost::function<void(const ros::MessageEvent<const Message>&)> receive_it =
        [this](const ros::MessageEvent<const Message>& event) {
          receive<Message>(event.getPublisherName(), event.getConstMessage());
        };
    return handle_.subscribe<Message>(name, kTopicQueue, receive_it);
  };
  ros::Subscriber old;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    old = subscriber_;
  }
  old.shutdown();  // waits for its callback, which takes the mutex
  const ros::Subscriber subscriber = transport == kRawTransport ? subscribed(sensor_msgs::Image())
                                                                : subscribed(sensor_msgs::CompressedImage());
  const std::lock_guard<std::mutex> lock(mutex_);
  subscriber_ = subscriber;
  transport_ = transport;
}

template <class Message>
void ImageTopic::receive(const std::string& publisher, const boost::shared_ptr<const Message>& message) {
  PublisherWatch::Verdict verdict;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    verdict = publishers_.judge(publisher, message->header.seq, subscriber_.getNumPublishers(),
                                ros::WallTime::now());
  }
  if (verdict.missed > 0) callbacks_.miss(verdict.missed);
  verdict.is_taken ? callbacks_.take(asImage(message)) : callbacks_.take_from_other();
}

std::string ImageTopic::nameWith(const std::string& transport) const {
  return base_name_ + (transport == kRawTransport ? "" : "/" + transport);
}

std::string ImageTopic::name() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return nameWith(transport_);
}

std::string ImageTopic::type() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return transport_ == kRawTransport ? "sensor_msgs/Image" : "sensor_msgs/CompressedImage";
}

bool ImageTopic::isPublished() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return subscriber_.getNumPublishers() > 0;
}

std::string ImageTopic::problem() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (publishers_.other().empty() || subscriber_.getNumPublishers() < 2) return "";
  return nameWith(transport_) + " has two publishers, " + publishers_.publisher() + " and " +
         publishers_.other() + "; only " + publishers_.publisher() + " is listened to; stop one of them";
}

}  // namespace depth_fusion
