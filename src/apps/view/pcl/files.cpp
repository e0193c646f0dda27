// Files that PCL reads.
#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/vtk_lib_io.h>
#include <pcl/point_types.h>

#include "apps/view/model.h"
#include "depth_fusion/common/error.h"
#include "surface_mesh/mesh_normals.h"

namespace depth_fusion {
namespace {

bool has(const pcl::PCLPointCloud2& cloud, const std::string& field) {
  return pcl::getFieldIndex(cloud, field) >= 0;
}

pcl::PolygonMesh readFile(const std::string& path) {
  pcl::PolygonMesh mesh;
  const bool is_pcd = path.size() > 4 && path.compare(path.size() - 4, 4, ".pcd") == 0;
  const int points = is_pcd ? (pcl::io::loadPCDFile(path, mesh.cloud) == 0 ? 1 : 0)
                            : static_cast<int>(pcl::io::loadPolygonFile(path, mesh) > 0);
  check(points > 0 && has(mesh.cloud, "x"), path + " cannot be read; is it there, and whole?");
  return mesh;
}

}  // namespace

TriangleMesh readByPcl(const std::string& path) {
  const pcl::PolygonMesh file = readFile(path);
  pcl::PointCloud<pcl::PointXYZRGBNormal> cloud;
  pcl::fromPCLPointCloud2(file.cloud, cloud);
  const bool has_normals = has(file.cloud, "normal_x");
  const bool has_colors = has(file.cloud, "rgb") || has(file.cloud, "rgba");
  TriangleMesh mesh;
  std::vector<uint32_t> numbers;  // points that are measured nowhere have none that counts
  for (const auto& point : cloud) {
    numbers.push_back(static_cast<uint32_t>(mesh.vertices.size()));
    if (!point.getVector3fMap().allFinite()) continue;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    if (has_normals) normal = point.getNormalVector3fMap();
    mesh.vertices.push_back({point.getVector3fMap(), normal});
    if (has_colors) mesh.colors.push_back({point.r, point.g, point.b});
  }
  for (const pcl::Vertices& polygon : file.polygons) {
    for (size_t i = 2; i < polygon.vertices.size(); ++i)
      mesh.triangles.push_back(
          {numbers[polygon.vertices[0]], numbers[polygon.vertices[i - 1]], numbers[polygon.vertices[i]]});
  }
  if (!has_normals) setNormals(mesh);
  return mesh;
}

}  // namespace depth_fusion
