#include "ros/conversions/mesh_message.h"

#include <string>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

constexpr uint64_t kMaxBytes = 1000000000;

}  // namespace

void MeshMessageSink::begin(const MeshSize& size) {
  const uint64_t vertex_bytes = 6 * sizeof(float) + (size.colored ? 3 : 0);
  const uint64_t bytes = vertex_bytes * size.vertices + 3 * sizeof(uint32_t) * size.triangles;
  check(bytes < kMaxBytes, "the mesh takes " + std::to_string(bytes / 1000000) +
                               " MB, more than a message may have; give a path, so that it is written to a "
                               "file, or simplification, max_triangles or max_error");
  message_.vertices.clear();
  message_.normals.clear();
  message_.colors.clear();
  message_.triangles.clear();
  message_.vertices.reserve(3 * size.vertices);
  message_.normals.reserve(3 * size.vertices);
  if (size.colored) message_.colors.reserve(3 * size.vertices);
  message_.triangles.reserve(3 * size.triangles);
}

void MeshMessageSink::addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const auto& [p, n] = vertices[i];
    message_.vertices.insert(message_.vertices.end(), p.data(), p.data() + 3);
    message_.normals.insert(message_.normals.end(), n.data(), n.data() + 3);
    if (colors != nullptr) message_.colors.insert(message_.colors.end(), colors[i].begin(), colors[i].end());
  }
}

void MeshMessageSink::addTriangles(const MeshTriangle* triangles, size_t count) {
  for (size_t i = 0; i < count; ++i)
    message_.triangles.insert(message_.triangles.end(), triangles[i].begin(), triangles[i].end());
}

}  // namespace depth_fusion
