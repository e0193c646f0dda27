// Triangle meshes: what receives one piece by piece, and one held in memory.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace depth_fusion {

struct MeshVertex {
  Eigen::Vector3f position_W;  // metres
  Eigen::Vector3f normal_W;    // unit length, into free space
};

using MeshColor = std::array<uint8_t, 3>;  // red, green, blue

// A triangle names its vertices by number, counter-clockwise as seen from free space.
using MeshTriangle = std::array<uint32_t, 3>;

struct MeshSize {
  uint64_t vertices = 0;
  uint64_t triangles = 0;
  bool colored = false;  // each vertex has a colour
};

// Receives a mesh whose size is known beforehand: begin() is called first, then vertices and triangles come
// in turn, each in order, then finish() is called. `colors` holds one colour a vertex, or is null if the mesh
// is not coloured. Triangles may name vertices that come later. Every call throws Error if the mesh cannot be
// kept.
class MeshSink {
 public:
  virtual ~MeshSink() = default;
  virtual void begin(const MeshSize& size) = 0;
  virtual void addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) = 0;
  virtual void addTriangles(const MeshTriangle* triangles, size_t count) = 0;
  virtual void finish() = 0;
};

struct TriangleMesh final : MeshSink {
  std::vector<MeshVertex> vertices;
  std::vector<MeshColor> colors;  // one a vertex, or none
  std::vector<MeshTriangle> triangles;

  void begin(const MeshSize& size) override {
    vertices.clear();
    colors.clear();
    triangles.clear();
    vertices.reserve(size.vertices);
    if (size.colored) colors.reserve(size.vertices);
    triangles.reserve(size.triangles);
  }
  void addVertices(const MeshVertex* added, const MeshColor* added_colors, size_t count) override {
    vertices.insert(vertices.end(), added, added + count);
    if (added_colors != nullptr) colors.insert(colors.end(), added_colors, added_colors + count);
  }
  void addTriangles(const MeshTriangle* added, size_t count) override {
    triangles.insert(triangles.end(), added, added + count);
  }
  void finish() override {}
};

// Sends the whole mesh in one piece.
inline void sendMesh(const TriangleMesh& mesh, MeshSink& sink) {
  const bool colored = !mesh.colors.empty();
  sink.begin({mesh.vertices.size(), mesh.triangles.size(), colored});
  sink.addVertices(mesh.vertices.data(), colored ? mesh.colors.data() : nullptr, mesh.vertices.size());
  sink.addTriangles(mesh.triangles.data(), mesh.triangles.size());
  sink.finish();
}

}  // namespace depth_fusion
