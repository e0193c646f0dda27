#include "ros/bags/bag_transforms.h"

#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

void addMessage(const rosbag::MessageInstance& place, const BagFiles& bags, tf2::BufferCore& tf) {
  try {
    const auto message = readMessage<tf2_msgs::TFMessage>(place, bags);
    for (geometry_msgs::TransformStamped transform : message->transforms) {
      transform.header.frame_id = withoutSlash(transform.header.frame_id);
      transform.child_frame_id = withoutSlash(transform.child_frame_id);
      tf.setTransform(transform, "bag", place.getTopic() == "/tf_static");
    }
  } catch (const Error&) {
    // A message that cannot be read connects nothing; whoever asks hears if the others do not either.
  }
}

}  // namespace

void addTransforms(const BagFiles& bags, tf2::BufferCore& tf) {
  rosbag::View view;
  bags.addTo(view, {"/tf", "/tf_static"});
  for (const rosbag::MessageInstance& place : view) addMessage(place, bags, tf);
}

std::optional<Pose> transformIn(const BagFiles& bags, const std::string& target, const std::string& source) {
  tf2::BufferCore tf;
  addTransforms(bags, tf);
  try {
    return fromMessage(
        tf.lookupTransform(withoutSlash(target), withoutSlash(source), ros::Time(0)).transform);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

}  // namespace depth_fusion
