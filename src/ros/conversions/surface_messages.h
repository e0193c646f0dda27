// The map's surface as ROS messages.
#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <string>
#include <vector>

#include "depth_fusion/map/block_map.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// The namespaces of the markers.
constexpr const char* kSurfaceMarkers = "surface";
constexpr const char* kBlockMarkers = "blocks";

// The mesh as a TRIANGLE_LIST with a colour a corner: the vertex's own, or of a mesh without colours one that
// shows which way the surface faces. rviz does not light coloured triangles.
visualization_msgs::Marker makeSurfaceMarker(const std::string& frame_id, int id, const TriangleMesh& mesh);
visualization_msgs::Marker makeDeletion(const std::string& frame_id, int id);
visualization_msgs::Marker makeDeletionOfAll(const std::string& frame_id);

// Shows the map's blocks as a CUBE_LIST.
visualization_msgs::Marker makeBlockMarker(const std::string& frame_id, const BlockMap& map);

// Keeps the first vertex of the mesh in each cube of a grid of that spacing, or all of them for a spacing of
// 0, and no triangle.
TriangleMesh thinned(const TriangleMesh& mesh, float spacing_m);

// The vertices of the meshes: x, y, z, normal_x, normal_y, normal_z and rgb, as PCL names and packs them.
sensor_msgs::PointCloud2 makePointCloud(const std_msgs::Header& header,
                                        const std::vector<const TriangleMesh*>& meshes);

}  // namespace depth_fusion
