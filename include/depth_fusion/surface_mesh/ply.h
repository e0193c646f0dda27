// Meshes as binary PLY files: x y z nx ny nz as floats, red green blue as uchars if the mesh is coloured,
// faces as lists of three ints.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

class WholeFile;

// Streams a mesh to a file; memory use does not depend on the mesh. Errors name the path and the reason. The
// file appears when finish() has succeeded; otherwise nothing is left of it, and a file that stood there
// stays.
class PlyWriter final : public MeshSink {
 public:
  // Throws Error if the file cannot be created.
  explicit PlyWriter(const std::string& path);
  ~PlyWriter() override;

  void begin(const MeshSize& size) override;
  void addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) override;
  void addTriangles(const MeshTriangle* triangles, size_t count) override;
  void finish() override;

 private:
  std::unique_ptr<WholeFile> file_;
  uint64_t vertex_offset_ = 0;
  uint64_t face_offset_ = 0;
  bool colored_ = false;
  std::vector<unsigned char> colored_vertices_, faces_;
};

void writePly(const std::string& path, const TriangleMesh& mesh);

// Reads a binary little-endian PLY file of triangles. Its vertices have float x y z, may have float nx ny nz
// and uchar red green blue, and any other numbers, which are skipped. Throws Error, which names the path and
// what is wrong.
TriangleMesh readPly(const std::string& path);

}  // namespace depth_fusion
