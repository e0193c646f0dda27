// Meshes as binary STL files: normal and three corners a triangle, no vertices shared, no colours.
#pragma once

#include <string>

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "surface_mesh/whole_file.h"

namespace depth_fusion {

// Streams a mesh to a file. A triangle may name vertices that come later, so the positions are kept behind
// the triangles until the end and then cut off.
class StlWriter final : public MeshSink {
 public:
  explicit StlWriter(const std::string& path) : file_(path) {}

  void begin(const MeshSize& size) override;
  void addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) override;
  void addTriangles(const MeshTriangle* triangles, size_t count) override;
  void finish() override;

 private:
  WholeFile file_;
  MeshSize size_;
  uint64_t facet_offset_ = 0;
  uint64_t position_offset_ = 0;
};

}  // namespace depth_fusion
