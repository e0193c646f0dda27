#include "ros/conversions/surface_points.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl_conversions/pcl_conversions.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <unordered_set>

#include "ros/conversions/surface_messages.h"

namespace depth_fusion {

TriangleMesh thinned(const TriangleMesh& mesh, float spacing_m) {
  TriangleMesh kept;
  std::unordered_set<uint64_t> taken;
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (spacing_m > 0.0f) {
      uint64_t cube = 0;
      for (const float coordinate_m : mesh.vertices[i].position_W)
        cube = cube << 21 | (static_cast<uint64_t>(std::floor(coordinate_m / spacing_m)) & 0x1fffff);
      if (!taken.insert(cube).second) continue;
    }
    kept.vertices.push_back(mesh.vertices[i]);
    if (!mesh.colors.empty()) kept.colors.push_back(mesh.colors[i]);
  }
  return kept;
}

boost::shared_ptr<SurfacePoints> makeSurfacePoints(const std_msgs::Header& header,
                                                   const Eigen::Vector3d& sensor_W,
                                                   const std::vector<const TriangleMesh*>& meshes) {
  const auto cloud = boost::make_shared<SurfacePoints>();
  pcl_conversions::toPCL(header, cloud->header);
  cloud->sensor_origin_.head<3>() = sensor_W.cast<float>();
  size_t points = 0;
  for (const TriangleMesh* mesh : meshes) points += mesh->vertices.size();
  cloud->reserve(points);
  for (const TriangleMesh* mesh : meshes) {
    for (size_t i = 0; i < mesh->vertices.size(); ++i) {
      pcl::PointXYZRGBNormal point;
      point.getVector3fMap() = mesh->vertices[i].position_W;
      point.getNormalVector3fMap() = mesh->vertices[i].normal_W;
      const MeshColor color = shownColor(*mesh, i);
      point.r = color[0];
      point.g = color[1];
      point.b = color[2];
      cloud->push_back(point);
    }
  }
  return cloud;
}

}  // namespace depth_fusion
