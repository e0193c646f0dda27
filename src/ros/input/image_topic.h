// A topic of images, raw or compressed.
#pragma once

#include <image_transport/subscriber.h>
#include <ros/node_handle.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "ros/conversions/image_message.h"
#include "ros/input/publisher_watch.h"

namespace depth_fusion {

class PublishedTopics;

constexpr char kRawTransport[] = "raw";
constexpr char kAutoTransport[] = "auto";
constexpr char kPointsTransport[] = "points";  // the topic itself is one of sensor_msgs/PointCloud2

class ImageTopic {
 public:
  struct Callbacks {
    std::function<void(const ImageMessage&)> take;
    std::function<void(uint32_t)> miss;     // so many messages were sent, and did not come
    std::function<void()> take_from_other;  // a message of another publisher, which is left out
  };

  // Subscribes `image`, as "depth/image", by that transport: raw, or what image_transport appends to the
  // name. Those of `own`, of which raw is the first, come as they are; another one is decoded by its plugin
  // as it arrives. "auto" is raw until lookAround() finds another one of `own` instead. The callbacks get one
  // message at a time, in the order that they come in, from the threads of the handle's callback queue.
  ImageTopic(const ros::NodeHandle& handle, const std::string& image, const std::string& transport,
             const std::vector<std::string>& own, const Callbacks& callbacks);
  // Waits for the callback in progress; there is none afterwards.
  ~ImageTopic() { end(); }
  ImageTopic(const ImageTopic&) = delete;
  ImageTopic& operator=(const ImageTopic&) = delete;

  // Subscribes the first of the topic's transports that is published, if the transport is "auto" and nobody
  // publishes the topic that is subscribed now. It takes two looks in a row that find the same: a driver that
  // has just begun may still be about to publish the first one.
  void lookAround(const PublishedTopics& published);

  // The name of the topic subscribed now.
  std::string name() const;
  bool isPublished() const;
  // Says which two nodes publish it; empty if they do not.
  std::string problem() const;

 private:
  void subscribe(const std::string& transport);
  template <class Message>
  ros::Subscriber subscribed(const std::string& transport);
  image_transport::Subscriber subscribedByPlugin(const std::string& transport);
  void end();
  uint32_t publisherCount() const;
  std::string nameWith(const std::string& transport) const;
  template <class Message>
  void receive(const std::string& publisher, const boost::shared_ptr<const Message>& message);

  ros::NodeHandle handle_;
  const std::string image_, base_name_;        // as given, and resolved
  const std::vector<std::string> own_;         // transports without plugins; raw first
  const std::vector<std::string> transports_;  // to choose from; one if it is given
  const Callbacks callbacks_;
  mutable std::mutex mutex_;  // of the rest
  PublisherWatch publishers_;
  std::string transport_;
  std::string found_;                              // the transport that the last look would have
  ros::Subscriber subscriber_;                     // of one of the own transports
  image_transport::Subscriber plugin_subscriber_;  // of another
};

}  // namespace depth_fusion
