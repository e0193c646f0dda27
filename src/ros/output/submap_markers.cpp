#include "ros/output/submap_markers.h"

#include <visualization_msgs/MarkerArray.h>

#include "ros/conversions/messages.h"

namespace depth_fusion {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

std_msgs::ColorRGBA colorOf(SubmapState state) {
  std_msgs::ColorRGBA color;
  color.a = 0.9f;
  color.r = state == SubmapState::kActive ? 0.2f : state == SubmapState::kInMemory ? 0.3f : 0.55f;
  color.g = state == SubmapState::kActive ? 0.9f : 0.55f;
  color.b = state == SubmapState::kActive ? 0.3f : state == SubmapState::kInMemory ? 1.0f : 0.55f;
  return color;
}

// The edges of a box.
Marker makeBox(const std::string& frame, const std::string& name, int id, const Eigen::AlignedBox3d& box_W,
               const std_msgs::ColorRGBA& color, double width_m) {
  Marker marker;
  marker.header = makeHeader(ros::Time(), frame);
  marker.ns = name;
  marker.id = id;
  marker.type = Marker::LINE_LIST;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = width_m;
  marker.color = color;
  for (int axis = 0; axis < 3; ++axis) {
    for (int edge = 0; edge < 4; ++edge) {
      Eigen::Vector3d from = box_W.min();
      from[(axis + 1) % 3] = (edge & 1) != 0 ? box_W.max()[(axis + 1) % 3] : from[(axis + 1) % 3];
      from[(axis + 2) % 3] = (edge & 2) != 0 ? box_W.max()[(axis + 2) % 3] : from[(axis + 2) % 3];
      Eigen::Vector3d to = from;
      to[axis] = box_W.max()[axis];
      for (const Eigen::Vector3d& end : {from, to}) {
        geometry_msgs::Point point;
        point.x = end.x();
        point.y = end.y();
        point.z = end.z();
        marker.points.push_back(point);
      }
    }
  }
  return marker;
}

}  // namespace

SubmapMarkers::SubmapMarkers(ros::NodeHandle& handle)
    : publisher_(handle.advertise<MarkerArray>("submaps", 1, true)) {}

void SubmapMarkers::publish(const std::string& map_frame, const SubmapCollection& submaps) {
  const ros::WallTime now = ros::WallTime::now();
  if (publisher_.getNumSubscribers() == 0 || now < next_) return;
  next_ = now + ros::WallDuration(1.0);
  MarkerArray markers;
  const std::vector<SubmapExtent> extents = submaps.extents();
  for (size_t i = 0; i < extents.size(); ++i)
    markers.markers.push_back(makeBox(map_frame, "submaps", static_cast<int>(i), extents[i].box_W,
                                      colorOf(extents[i].state), 0.02));
  std_msgs::ColorRGBA white;
  white.r = white.g = white.b = 1.0f;
  white.a = 0.4f;
  markers.markers.push_back(makeBox(map_frame, "window", 0, submaps.windowBox(), white, 0.005));
  for (size_t i = extents.size(); i < shown_; ++i) {
    markers.markers.push_back(makeBox(map_frame, "submaps", static_cast<int>(i), {}, white, 0.0));
    markers.markers.back().action = Marker::DELETE;
  }
  shown_ = extents.size();
  publisher_.publish(markers);
}

}  // namespace depth_fusion
