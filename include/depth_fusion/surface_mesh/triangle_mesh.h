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

// Vertices by number, counter-clockwise seen from free space.
using MeshTriangle = std::array<uint32_t, 3>;

struct MeshSize {
  uint64_t vertices = 0;
  uint64_t triangles = 0;
};

// Receives a mesh whose size is known beforehand: begin, then vertices and triangles in turn, each in order,
// then finish. Triangles may name vertices yet to come. Throws Error if the mesh cannot be kept.
class MeshSink {
 public:
  virtual ~MeshSink() = default;
  virtual void begin(const MeshSize& size) = 0;
  virtual void addVertices(const MeshVertex* vertices, size_t count) = 0;
  virtual void addTriangles(const MeshTriangle* triangles, size_t count) = 0;
  virtual void finish() = 0;
};

struct TriangleMesh final : MeshSink {
  std::vector<MeshVertex> vertices;
  std::vector<MeshTriangle> triangles;

  void begin(const MeshSize& size) override {
    vertices.clear();
    triangles.clear();
    vertices.reserve(size.vertices);
    triangles.reserve(size.triangles);
  }
  void addVertices(const MeshVertex* added, size_t count) override {
    vertices.insert(vertices.end(), added, added + count);
  }
  void addTriangles(const MeshTriangle* added, size_t count) override {
    triangles.insert(triangles.end(), added, added + count);
  }
  void finish() override {}
};

}  // namespace depth_fusion
