#include "surface_mesh/mesh_extraction.h"

#include <algorithm>
#include <limits>

#include "depth_fusion/common/error.h"

namespace depth_fusion {

void countBlocks(SurfaceMeshKernels& kernels, const BlockIndex& origin, std::vector<MeshBlock>& blocks) {
  std::vector<MeshBlockArgs> batch;
  for (size_t begin = 0; begin < blocks.size(); begin += batch.size()) {
    const size_t end = std::min(begin + kernels.limits().blocks, blocks.size());
    batch.clear();
    for (size_t i = begin; i < end; ++i) batch.push_back(blockArgs(origin, blocks[i]));
    kernels.classify(batch);
    const auto totals = kernels.totals(batch.size());
    for (size_t i = begin; i < end; ++i) {
      blocks[i].vertices = totals[i - begin].vertices;
      blocks[i].triangles = blocks[i].lends_only ? 0 : totals[i - begin].triangles;
    }
  }
  blocks.erase(
      std::remove_if(blocks.begin(), blocks.end(),
                     [](const MeshBlock& block) { return block.vertices == 0 && block.triangles == 0; }),
      blocks.end());
}

MeshSize numberVertices(std::vector<MeshBlock>& blocks) {
  MeshSize size;
  for (MeshBlock& block : blocks) {
    block.first_vertex = static_cast<uint32_t>(size.vertices);
    size.vertices += block.vertices;
    size.triangles += block.triangles;
  }
  check(size.vertices <= static_cast<uint64_t>(std::numeric_limits<int32_t>::max()),
        "the mesh would have " + std::to_string(size.vertices) +
            " vertices, over the 2147483647 that a mesh can number; use a larger map/voxel_size_m");
  return size;
}

MeshEmission::MeshEmission(SurfaceMeshKernels& kernels, const BlockIndex& origin,
                           const std::vector<MeshBlock>& blocks, bool colored, MeshSink& sink)
    : kernels_(kernels), batcher_(origin, blocks, kernels.limits()), colored_(colored), sink_(sink) {}

void MeshEmission::emitUpTo(size_t end) {
  for (; !batcher_.done(end); ++batches_) {
    const MeshBatch batch = batcher_.next(end);
    kernels_.classify(batch.blocks);
    kernels_.emitVertices(batch, vertices_);
    if (colored_) kernels_.colorVertices(batch, colors_);
    sink_.addVertices(vertices_.data(), colored_ ? colors_.data() : nullptr, vertices_.size());
    kernels_.emitTriangles(batch, triangles_);
    sink_.addTriangles(triangles_.data(), triangles_.size());
  }
}

}  // namespace depth_fusion
