// The map's surface as ROS messages.
#pragma once

#include <visualization_msgs/Marker.h>

#include <string>

#include "depth_fusion/map/block_map.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// The namespaces of the markers.
constexpr const char* kSurfaceMarkers = "surface";
constexpr const char* kBlockMarkers = "blocks";

// The vertex's own colour, or of a mesh without colours one that shows which way the surface faces.
MeshColor shownColor(const TriangleMesh& mesh, size_t vertex);

// The mesh as a TRIANGLE_LIST with a colour a corner: the vertex's own, or of a mesh without colours one that
// shows which way the surface faces. rviz does not light coloured triangles.
visualization_msgs::Marker makeSurfaceMarker(const std::string& frame_id, int id, const TriangleMesh& mesh);
visualization_msgs::Marker makeDeletion(const std::string& frame_id, int id);
visualization_msgs::Marker makeDeletionOfAll(const std::string& frame_id);

// Shows the map's blocks as a CUBE_LIST.
visualization_msgs::Marker makeBlockMarker(const std::string& frame_id, const BlockMap& map);

}  // namespace depth_fusion
