#include "ros/bags/realsense_viewer.h"

#include <geometry_msgs/Transform.h>
#include <std_msgs/Float32.h>

#include <cmath>

#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

// The first message on the first topic of that name's begin; null if there is none.
template <class Message>
boost::shared_ptr<const Message> firstMessage(const BagFiles& bags, const std::string& begin,
                                              const std::string& type) {
  for (const BagTopic& topic : bags.topics()) {
    if (topic.type != type || topic.name.rfind(begin, 0) != 0) continue;
    rosbag::View view;
    bags.addTo(view, {topic.name});
    return readMessage<Message>(*view.begin(), bags);
  }
  return nullptr;
}

// From the viewer's reference stream to the stream of these images.
std::optional<Pose> fromReference(const BagFiles& bags, const std::string& image_topic) {
  const auto transform = firstMessage<geometry_msgs::Transform>(bags, viewerStream(image_topic) + "/tf/",
                                                                "geometry_msgs/Transform");
  return transform ? std::optional<Pose>(fromMessage(*transform)) : std::nullopt;
}

}  // namespace

std::optional<double> viewerDepthUnit(const BagFiles& bags, const std::string& depth_topic) {
  constexpr double kSteps = 1e9;  // a metre; the message has seven digits
  const std::string stream = viewerStream(depth_topic);
  const std::string option = stream.substr(0, stream.rfind('/')) + "/option/Depth_Units/value";
  const auto unit = firstMessage<std_msgs::Float32>(bags, option, "std_msgs/Float32");
  if (unit == nullptr || !(unit->data > 0.0f)) return std::nullopt;
  return std::round(kSteps * static_cast<double>(unit->data)) / kSteps;
}

std::optional<Pose> viewerTransform(const BagFiles& bags, const std::string& color_topic,
                                    const std::string& depth_topic) {
  const auto T_C_R = fromReference(bags, color_topic);
  const auto T_D_R = fromReference(bags, depth_topic);
  if (!T_C_R || !T_D_R) return std::nullopt;
  return *T_C_R * T_D_R->inverse();
}

}  // namespace depth_fusion
