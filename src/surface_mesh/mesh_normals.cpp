#include "surface_mesh/mesh_normals.h"

#include <Eigen/Geometry>

namespace depth_fusion {

void setNormals(TriangleMesh& mesh) {
  for (MeshVertex& vertex : mesh.vertices) vertex.normal_W.setZero();
  for (const MeshTriangle& t : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[t[0]].position_W;
    const Eigen::Vector3f normal =
        (mesh.vertices[t[1]].position_W - a).cross(mesh.vertices[t[2]].position_W - a);
    for (const uint32_t vertex : t) mesh.vertices[vertex].normal_W += normal;
  }
  for (MeshVertex& vertex : mesh.vertices) vertex.normal_W.normalize();
}

}  // namespace depth_fusion
