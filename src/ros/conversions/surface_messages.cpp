#include "ros/conversions/surface_messages.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace depth_fusion {
namespace {

using visualization_msgs::Marker;

// How much light from there a surface gets; softer than Lambert's cosine, so that noise in walls hardly
// shows.
float received(const Eigen::Vector3f& light, const Eigen::Vector3f& normal) {
  const float half_lambert = 0.5f + 0.5f * normal.dot(light);
  return half_lambert * half_lambert;
}

// Two lights of one hue, so that surfaces that face different ways look different, and those seen from behind
// no other than the rest.
MeshColor shadeOf(const Eigen::Vector3f& normal) {
  const Eigen::Vector3f key = Eigen::Vector3f(-0.5f, 0.35f, 0.8f).normalized();
  const Eigen::Vector3f fill = Eigen::Vector3f(0.6f, -0.8f, -0.1f).normalized();
  const Eigen::Vector3f color = Eigen::Vector3f(0.11f, 0.11f, 0.11f) +
                                received(key, normal) * Eigen::Vector3f(0.80f, 0.77f, 0.72f) +
                                received(fill, normal) * Eigen::Vector3f(0.27f, 0.26f, 0.24f);
  MeshColor rgb;
  for (int channel = 0; channel < 3; ++channel)
    rgb[channel] = static_cast<uint8_t>(std::lround(255.0f * std::min(1.0f, color[channel])));
  return rgb;
}

// The stamp of zero means to rviz: wherever the frame is now.
Marker makeMarker(const std::string& frame_id, const std::string& marker_namespace, int id, int action) {
  Marker marker;
  marker.header.frame_id = frame_id;
  marker.ns = marker_namespace;
  marker.id = id;
  marker.action = action;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1.0f;
  return marker;
}

geometry_msgs::Point pointOf(const Eigen::Vector3f& p) {
  geometry_msgs::Point point;
  point.x = p.x();
  point.y = p.y();
  point.z = p.z();
  return point;
}

std_msgs::ColorRGBA colorMessage(const MeshColor& color) {
  std_msgs::ColorRGBA message;
  message.r = color[0] / 255.0f;
  message.g = color[1] / 255.0f;
  message.b = color[2] / 255.0f;
  message.a = 1.0f;
  return message;
}

}  // namespace

MeshColor shownColor(const TriangleMesh& mesh, size_t vertex) {
  return mesh.colors.empty() ? shadeOf(mesh.vertices[vertex].normal_W) : mesh.colors[vertex];
}

Marker makeSurfaceMarker(const std::string& frame_id, int id, const TriangleMesh& mesh) {
  Marker marker = makeMarker(frame_id, kSurfaceMarkers, id, Marker::ADD);
  marker.type = Marker::TRIANGLE_LIST;
  marker.points.reserve(3 * mesh.triangles.size());
  marker.colors.reserve(3 * mesh.triangles.size());
  std::vector<std_msgs::ColorRGBA> colors;
  colors.reserve(mesh.vertices.size());
  for (size_t i = 0; i < mesh.vertices.size(); ++i) colors.push_back(colorMessage(shownColor(mesh, i)));
  for (const MeshTriangle& triangle : mesh.triangles) {
    for (const uint32_t vertex : triangle) {
      marker.points.push_back(pointOf(mesh.vertices[vertex].position_W));
      marker.colors.push_back(colors[vertex]);
    }
  }
  return marker;
}

Marker makeDeletion(const std::string& frame_id, int id) {
  return makeMarker(frame_id, kSurfaceMarkers, id, Marker::DELETE);
}

Marker makeDeletionOfAll(const std::string& frame_id) {
  return makeMarker(frame_id, kSurfaceMarkers, 0, Marker::DELETEALL);
}

Marker makeBlockMarker(const std::string& frame_id, const BlockMap& map) {
  Marker marker = makeMarker(frame_id, kBlockMarkers, 0, Marker::ADD);
  marker.type = Marker::CUBE_LIST;
  const float edge_m = map.parameters().voxel_size_m * static_cast<float>(map.parameters().block_size);
  // A voxel samples its lowest corner, so a block's surface lies in its cube.
  for (const SlotTable::Block& block : map.slots().blocks())
    marker.points.push_back(pointOf(edge_m * (block.index.cast<float>() + Eigen::Vector3f::Constant(0.5f))));
  marker.scale.x = marker.scale.y = marker.scale.z = 0.9 * edge_m;
  marker.color.r = 0.25f;
  marker.color.g = 0.65f;
  marker.color.b = 1.0f;
  marker.color.a = 0.25f;
  if (marker.points.empty()) marker.action = Marker::DELETE;
  return marker;
}

}  // namespace depth_fusion
