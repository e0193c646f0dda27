#include "surface_mesh/mesh_extraction.h"

#include <algorithm>
#include <limits>

#include "depth_fusion/common/error.h"

namespace depth_fusion {
namespace {

// The first pass counts the vertices and triangles of each block.
void countBlocks(SurfaceMeshKernels& kernels, const BlockMap& map, std::vector<MeshBlock>& blocks) {
  std::vector<MeshBlockArgs> batch;
  for (size_t begin = 0; begin < blocks.size(); begin += batch.size()) {
    const size_t end = std::min(begin + kernels.limits().blocks, blocks.size());
    batch.clear();
    for (size_t i = begin; i < end; ++i) batch.push_back(blockArgs(map, blocks[i]));
    kernels.classify(batch);
    const auto totals = kernels.totals(batch.size());
    for (size_t i = begin; i < end; ++i) {
      blocks[i].vertices = totals[i - begin].vertices;
      blocks[i].triangles = blocks[i].lends_only ? 0 : totals[i - begin].triangles;
    }
  }
}

// Leaves out the blocks without surface and numbers the vertices of the others.
MeshSize numberVertices(std::vector<MeshBlock>& blocks) {
  blocks.erase(
      std::remove_if(blocks.begin(), blocks.end(),
                     [](const MeshBlock& block) { return block.vertices == 0 && block.triangles == 0; }),
      blocks.end());
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

// The second pass emits the mesh itself. Returns the number of batches.
size_t emitBlocks(SurfaceMeshKernels& kernels, const BlockMap& map, const std::vector<MeshBlock>& blocks,
                  bool colored, MeshSink& sink) {
  MeshBatcher batcher(map, blocks, kernels.limits());
  std::vector<MeshVertex> vertices;
  std::vector<MeshColor> colors;
  std::vector<MeshTriangle> triangles;
  size_t batches = 0;
  for (; !batcher.done(); ++batches) {
    const MeshBatch batch = batcher.next();
    kernels.classify(batch.blocks);
    kernels.emitVertices(batch, vertices);
    if (colored) kernels.colorVertices(batch, colors);
    sink.addVertices(vertices.data(), colored ? colors.data() : nullptr, vertices.size());
    kernels.emitTriangles(batch, triangles);
    sink.addTriangles(triangles.data(), triangles.size());
  }
  return batches;
}

}  // namespace

size_t extractBlocks(SurfaceMeshKernels& kernels, const BlockMap& map, std::vector<MeshBlock>& blocks,
                     MeshSink& sink, MeshSize& size) {
  countBlocks(kernels, map, blocks);
  size = numberVertices(blocks);
  size.colored = map.hasLayer(kColorLayer);
  sink.begin(size);
  const size_t batches = emitBlocks(kernels, map, blocks, size.colored, sink);
  sink.finish();
  return batches;
}

}  // namespace depth_fusion
