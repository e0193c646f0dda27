#include "surface_mesh/mesh_part.h"

#include <limits>

namespace depth_fusion {

TriangleMesh partOf(const TriangleMesh& mesh, const std::vector<MeshTriangle>& triangles) {
  constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> numbers(mesh.vertices.size(), kUnused);
  TriangleMesh part;
  part.triangles = triangles;
  for (MeshTriangle& triangle : part.triangles) {
    for (uint32_t& vertex : triangle) {
      uint32_t& number = numbers[vertex];
      if (number == kUnused) {
        number = static_cast<uint32_t>(part.vertices.size());
        part.vertices.push_back(mesh.vertices[vertex]);
        if (!mesh.colors.empty()) part.colors.push_back(mesh.colors[vertex]);
      }
      vertex = number;
    }
  }
  return part;
}

}  // namespace depth_fusion
