// A mesh as a ROS message.
#pragma once

#include <depth_fusion/MeshGeometry.h>

#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

// Puts a mesh into a message, but for the header. Throws Error for one that is too large to be sent: roscpp
// takes no messages above a gigabyte.
class MeshMessageSink final : public MeshSink {
 public:
  // Keeps a reference.
  explicit MeshMessageSink(MeshGeometry& message) : message_(message) {}

  void begin(const MeshSize& size) override;
  void addVertices(const MeshVertex* vertices, const MeshColor* colors, size_t count) override;
  void addTriangles(const MeshTriangle* triangles, size_t count) override;
  void finish() override {}

 private:
  MeshGeometry& message_;
};

}  // namespace depth_fusion
