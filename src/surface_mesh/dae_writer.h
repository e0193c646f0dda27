// Meshes as COLLADA 1.4 files, which Gazebo and MoveIt read: positions in metres, normals, vertex colours if
// the mesh is coloured.
#pragma once

#include <string>

#include "depth_fusion/surface_mesh/mesh_file.h"
#include "surface_mesh/whole_file.h"

namespace depth_fusion {

// Streams a mesh to a file. Lines have fixed widths, so that positions, normals, colours and triangles can be
// written in turn and yet stand one after the other.
class DaeWriter final : public MeshSink {
 public:
  DaeWriter(const std::string& path, UpAxis up) : file_(path), up_(up) {}

  void begin(const MeshSize& size) override;
  void addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) override;
  void addTriangles(const MeshTriangle* triangles, size_t count) override;
  void finish() override { file_.commit(); }

 private:
  // Writes the text at the offset, which it moves on.
  void write(uint64_t& offset, const std::string& text);
  // Writes what stands about an array of triples, and returns where the numbers begin.
  uint64_t writeSource(uint64_t& offset, const std::string& name, const std::string& axes, uint64_t count,
                       uint64_t bytes_each);

  WholeFile file_;
  UpAxis up_;
  uint64_t positions_ = 0, normals_ = 0, colors_ = 0, faces_ = 0;  // offsets of the next ones
  int index_width_ = 1;
};

}  // namespace depth_fusion
