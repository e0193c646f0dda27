#include "ros/input/image_topic.h"

#include <ros/message_event.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "ros/input/published_topics.h"
#include "ros/input/transport_plugin.h"

namespace depth_fusion {
namespace {

// Callbacks only hand messages on, to a queue of two or so whose losses are counted, so that this one is
// always nearly empty; within a process roscpp would drop from it without a trace.
constexpr uint32_t kTopicQueue = 10;

ImageMessage asImage(const sensor_msgs::ImageConstPtr& message) { return {message, nullptr}; }
ImageMessage asImage(const sensor_msgs::CompressedImageConstPtr& message) { return {nullptr, message}; }
ImageMessage asImage(const sensor_msgs::PointCloud2ConstPtr& message) { return {nullptr, nullptr, message}; }

}  // namespace

ImageTopic::ImageTopic(const ros::NodeHandle& handle, const std::string& image, const std::string& transport,
                       const std::vector<std::string>& own, const Callbacks& callbacks)
    : handle_(handle),
      image_(image),
      base_name_(handle_.resolveName(image)),
      own_(own),
      transports_(transport == kAutoTransport ? own_ : std::vector<std::string>{transport}),
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
  end();
  const bool is_own = std::find(own_.begin(), own_.end(), transport) != own_.end();
  ros::Subscriber subscriber;
  image_transport::Subscriber plugin_subscriber;
  if (transport == kRawTransport) {
    subscriber = subscribed<sensor_msgs::Image>(transport);
  } else if (transport == kPointsTransport) {
    subscriber = subscribed<sensor_msgs::PointCloud2>(transport);
  } else if (is_own) {
    subscriber = subscribed<sensor_msgs::CompressedImage>(transport);
  } else {
    plugin_subscriber = subscribedByPlugin(transport);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  subscriber_ = subscriber;
  plugin_subscriber_ = plugin_subscriber;
  transport_ = transport;
}

template <class Message>
ros::Subscriber ImageTopic::subscribed(const std::string& transport) {
  const boost::function<void(const ros::MessageEvent<const Message>&)> receive_it =
      [this](const ros::MessageEvent<const Message>& event) {
        receive<Message>(event.getPublisherName(), event.getConstMessage());
      };
  return handle_.subscribe<Message>(nameWith(transport), kTopicQueue, receive_it);
}

// Plugins do not tell who published an image.
image_transport::Subscriber ImageTopic::subscribedByPlugin(const std::string& transport) {
  return subscribeByPlugin(handle_, image_, transport, kTopicQueue,
                           [this](const sensor_msgs::ImageConstPtr& image) { receive("", image); });
}

void ImageTopic::end() {
  ros::Subscriber subscriber;
  image_transport::Subscriber plugin_subscriber;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    subscriber = subscriber_;
    plugin_subscriber = plugin_subscriber_;
  }
  // They wait for their callback, which takes the mutex.
  subscriber.shutdown();
  plugin_subscriber.shutdown();
}

uint32_t ImageTopic::publisherCount() const {
  return subscriber_ ? subscriber_.getNumPublishers() : plugin_subscriber_.getNumPublishers();
}

template <class Message>
void ImageTopic::receive(const std::string& publisher, const boost::shared_ptr<const Message>& message) {
  PublisherWatch::Verdict verdict;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    verdict = publishers_.judge(publisher, message->header.seq, publisherCount(), ros::WallTime::now());
  }
  if (verdict.missed > 0) callbacks_.miss(verdict.missed);
  verdict.is_taken ? callbacks_.take(asImage(message)) : callbacks_.take_from_other();
}

std::string ImageTopic::nameWith(const std::string& transport) const {
  const bool is_topic_itself = transport == kRawTransport || transport == kPointsTransport;
  return base_name_ + (is_topic_itself ? "" : "/" + transport);
}

std::string ImageTopic::name() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return nameWith(transport_);
}

bool ImageTopic::isPublished() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return publisherCount() > 0;
}

std::string ImageTopic::problem() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (publisherCount() < 2) return "";
  if (plugin_subscriber_)
    return nameWith(transport_) +
           " has two publishers, whose images its plugin does not tell apart; stop one of them";
  if (publishers_.other().empty()) return "";
  return nameWith(transport_) + " has two publishers, " + publishers_.publisher() + " and " +
         publishers_.other() + "; only " + publishers_.publisher() + " is listened to; stop one of them";
}

}  // namespace depth_fusion
