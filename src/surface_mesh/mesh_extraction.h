// The surface of some of the map's blocks, in two passes: the first counts, the second emits.
#pragma once

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "surface_mesh/mesh_batches.h"
#include "surface_mesh/surface_mesh_kernels.h"

namespace depth_fusion {

// Counts the vertices and triangles of the blocks, which are in Morton order, and leaves out of the list
// those without any; lends_only blocks have vertices but no triangles.
void countBlocks(SurfaceMeshKernels& kernels, const BlockIndex& origin, std::vector<MeshBlock>& blocks);

// Numbers the vertices of blocks that are counted. Throws Error if there are too many.
MeshSize numberVertices(std::vector<MeshBlock>& blocks);

// Emits the blocks of a list, which are numbered and in Morton order.
class MeshEmission {
 public:
  // Keeps references.
  MeshEmission(SurfaceMeshKernels& kernels, const BlockIndex& origin, const std::vector<MeshBlock>& blocks,
               bool colored, MeshSink& sink);

  // Emits the blocks before `end` that are not emitted yet, whose voxels the map has, and those beside them.
  void emitUpTo(size_t end);
  size_t batches() const { return batches_; }

 private:
  SurfaceMeshKernels& kernels_;
  MeshBatcher batcher_;
  bool colored_;
  MeshSink& sink_;
  std::vector<MeshVertex> vertices_;
  std::vector<MeshColor> colors_;
  std::vector<MeshTriangle> triangles_;
  size_t batches_ = 0;
};

}  // namespace depth_fusion
