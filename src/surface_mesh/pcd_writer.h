// The vertices of meshes as binary PCD files, as PCL reads them: x y z and normal, with rgb if the mesh is
// coloured.
#pragma once

#include <string>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "surface_mesh/whole_file.h"

namespace depth_fusion {

class PcdWriter final : public MeshSink {
 public:
  explicit PcdWriter(const std::string& path) : file_(path) {}

  void begin(const MeshSize& size) override;
  void addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) override;
  void addTriangles(const MeshTriangle*, size_t) override {}
  void finish() override { file_.commit(); }

 private:
  WholeFile file_;
  uint64_t offset_ = 0;
  std::vector<unsigned char> points_;
};

}  // namespace depth_fusion
