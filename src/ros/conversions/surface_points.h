// The map's surface as a point cloud of PCL's.
#pragma once

#include <std_msgs/Header.h>

#include <Eigen/Core>
#include <boost/shared_ptr.hpp>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace pcl {
struct PointXYZRGBNormal;
template <class Point>
class PointCloud;
}  // namespace pcl

namespace depth_fusion {

// Within a process it is handed over as it is; for others pcl_ros makes a sensor_msgs/PointCloud2 of it.
using SurfacePoints = pcl::PointCloud<pcl::PointXYZRGBNormal>;

// Keeps the first vertex of the mesh in each cube of a grid of that spacing, or all of them for a spacing of
// 0, and no triangle.
TriangleMesh thinned(const TriangleMesh& mesh, float spacing_m);

// The vertices of the meshes with the colours that viewers are shown. The sensor's position becomes the
// cloud's sensor_origin_, which messages do not have.
boost::shared_ptr<SurfacePoints> makeSurfacePoints(const std_msgs::Header& header,
                                                   const Eigen::Vector3d& sensor_W,
                                                   const std::vector<const TriangleMesh*>& meshes);

}  // namespace depth_fusion
