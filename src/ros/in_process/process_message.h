// What nodelets of one manager hand to each other by pointer: data on the compute device, features, shared
// images.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>

#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <memory>

namespace depth_fusion {

// Length of the queues of topics between nodelets, which never fill: their callbacks only hand on what comes.
// Frames wait, and are dropped and counted, in a nodelet's own queue of `queue_size`.
constexpr uint32_t kProcessQueue = 100;

// A message whose payload never leaves the process. To other processes it is its header (so that `rostopic
// hz` works); what comes from them has no payload.
template <class Payload>
struct ProcessMessage {
  using Ptr = boost::shared_ptr<ProcessMessage>;
  using ConstPtr = boost::shared_ptr<const ProcessMessage>;

  std_msgs::Header header;
  std::shared_ptr<const Payload> payload;
};

template <class Payload>
boost::shared_ptr<ProcessMessage<Payload>> makeMessage(const std_msgs::Header& header,
                                                       std::shared_ptr<const Payload> payload) {
  auto message = boost::make_shared<ProcessMessage<Payload>>();
  message->header = header;
  message->payload = std::move(payload);
  return message;
}

}  // namespace depth_fusion

namespace ros {
namespace message_traits {

template <class Payload>
struct IsMessage<depth_fusion::ProcessMessage<Payload>> : TrueType {};
template <class Payload>
struct IsMessage<const depth_fusion::ProcessMessage<Payload>> : TrueType {};
template <class Payload>
struct HasHeader<depth_fusion::ProcessMessage<Payload>> : TrueType {};
template <class Payload>
struct MD5Sum<depth_fusion::ProcessMessage<Payload>> : MD5Sum<std_msgs::Header> {
  static const char* value() { return MD5Sum<std_msgs::Header>::value(); }
  static const char* value(const depth_fusion::ProcessMessage<Payload>&) { return value(); }
};
template <class Payload>
struct DataType<depth_fusion::ProcessMessage<Payload>> {
  static const char* value() { return DataType<std_msgs::Header>::value(); }
  static const char* value(const depth_fusion::ProcessMessage<Payload>&) { return value(); }
};
template <class Payload>
struct Definition<depth_fusion::ProcessMessage<Payload>> {
  static const char* value() { return Definition<std_msgs::Header>::value(); }
  static const char* value(const depth_fusion::ProcessMessage<Payload>&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <class Payload>
struct Serializer<depth_fusion::ProcessMessage<Payload>> {
  template <class Stream>
  static void write(Stream& stream, const depth_fusion::ProcessMessage<Payload>& message) {
    stream.next(message.header);
  }
  template <class Stream>
  static void read(Stream& stream, depth_fusion::ProcessMessage<Payload>& message) {
    stream.next(message.header);
  }
  static uint32_t serializedLength(const depth_fusion::ProcessMessage<Payload>& message) {
    return ros::serialization::serializationLength(message.header);
  }
};

}  // namespace serialization
}  // namespace ros
