// Typed launches of the surface mesh's kernels, and the memory they share.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "surface_mesh/mesh_batches.h"

namespace depth_fusion {

class SurfaceMeshKernels {
 public:
  struct Totals {
    uint32_t vertices, triangles;
  };

  // Allocates memory for batches of up to max_batch_blocks blocks, fewer where that would take too much.
  SurfaceMeshKernels(ComputeContext& compute, BlockMap& map, int min_certainty, size_t max_batch_blocks);

  const BatchLimits& limits() const { return limits_; }
  size_t deviceBytes() const;

  // Gathers and classifies the blocks of a batch; given a count, the first blocks of blockArgs().
  void classify(const std::vector<MeshBlockArgs>& blocks);
  void classify(size_t count);
  DeviceBuffer& blockArgs() { return block_args_; }
  // What each of the blocks classified last has.
  std::vector<Totals> totals(size_t count) const;
  // These emit the batch classified last. The vectors keep their memory from batch to batch.
  void emitVertices(const MeshBatch& batch, std::vector<MeshVertex>& vertices);
  // Colours the vertices emitted last. The map must have colour.
  void colorVertices(const MeshBatch& batch, std::vector<MeshColor>& colors);
  void emitTriangles(const MeshBatch& batch, std::vector<MeshTriangle>& triangles);

  // These emit the first `count` blocks and leave them on the device: six floats a vertex, three vertices a
  // triangle.
  const DeviceBuffer& emitVertices(size_t count, uint32_t first_vertex);
  const DeviceBuffer& emitTriangles(size_t count);

 private:
  BlockMap& map_;
  int min_certainty_;
  size_t rows_;         // of a block
  size_t padded_size_;  // voxels per axis of a gathered block
  BatchLimits limits_;
  DeviceBuffer table_, block_args_, volume_, row_masks_, row_vertices_, row_triangles_, totals_, vertices_,
      vertex_colors_, triangles_;
  Kernel gather_, classify_, scan_, emit_vertices_, color_vertices_, emit_triangles_;
};

}  // namespace depth_fusion
