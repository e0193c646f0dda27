// Meshes as binary glTF 2.0 files: positions in metres, normals, vertex colours if the mesh is coloured.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "surface_mesh/glb_file.h"

namespace depth_fusion {

class GlbWriter final : public MeshSink {
 public:
  GlbWriter(const std::string& path, UpAxis up) : file_(path), up_(up) {}

  void begin(const MeshSize& size) override;
  void addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) override;
  void addTriangles(const MeshTriangle* triangles, size_t count) override;
  void finish() override;

 private:
  std::string description() const;

  GlbFile file_;
  UpAxis up_;
  MeshSize size_;
  uint64_t vertices_ = 0, triangles_ = 0;  // so far
  GlbPart positions_, normals_, colors_, indices_;
  Eigen::AlignedBox3f box_;
};

}  // namespace depth_fusion
