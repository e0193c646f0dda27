// Meshes as Wavefront OBJ files: v x y z, with red green blue from 0 to 1 if the mesh is coloured, vn, and f
// a//a b//b c//c.
#pragma once

#include <sstream>
#include <string>

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "surface_mesh/whole_file.h"

namespace depth_fusion {

// Streams a mesh to a file. Lines have fixed widths, so that vertices and triangles can be written in turn
// and yet stand one after the other, as many readers want them.
class ObjWriter final : public MeshSink {
 public:
  explicit ObjWriter(const std::string& path);

  void begin(const MeshSize& size) override;
  void addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) override;
  void addTriangles(const MeshTriangle* triangles, size_t count) override;
  void finish() override { file_.commit(); }

 private:
  // Writes the lines that text_ has gathered.
  void flush(uint64_t& offset);

  WholeFile file_;
  std::ostringstream text_;
  uint64_t vertex_offset_ = 0;
  uint64_t face_offset_ = 0;
  int index_width_ = 1;
};

}  // namespace depth_fusion
