#include "ros/output/viewer_aids.h"

#include <visualization_msgs/Marker.h>

#include "ros/conversions/messages.h"

namespace depth_fusion {

using visualization_msgs::Marker;

ViewerAids::ViewerAids(ros::NodeHandle private_handle, const std::string& map_frame,
                       const std::string& view_frame)
    : map_frame_(map_frame),
      view_(map_frame, view_frame),
      sign_publisher_(private_handle.advertise<Marker>("state_marker", 1, true)) {}

void ViewerAids::showTracked(const ros::Time& stamp, const Pose& T_map_camera) {
  camera_ = T_map_camera.translation();
  if (!sign_.empty()) publishSign(Marker::DELETE, "");
  view_.follow(stamp, T_map_camera);
}

void ViewerAids::showSign(const std::string& text) {
  if (text != sign_) publishSign(Marker::ADD, text);
}

void ViewerAids::publishSign(int action, const std::string& text) {
  constexpr double kAbove_m = 0.25, kHeight_m = 0.12;
  sign_ = text;
  Marker marker;
  marker.header = makeHeader(ros::Time(), map_frame_);  // a stamp of zero: wherever the frame is now
  marker.ns = "state";
  marker.type = Marker::TEXT_VIEW_FACING;
  marker.action = action;
  marker.text = text;
  marker.pose.position.x = camera_.x();
  marker.pose.position.y = camera_.y();
  marker.pose.position.z = camera_.z() + kAbove_m;
  marker.pose.orientation.w = 1.0;
  marker.scale.z = kHeight_m;
  marker.color.r = marker.color.a = 1.0f;
  marker.color.g = 0.3f;
  sign_publisher_.publish(marker);
}

}  // namespace depth_fusion
