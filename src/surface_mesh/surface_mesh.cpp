#include "depth_fusion/surface_mesh/surface_mesh.h"

#include <algorithm>
#include <limits>

#include "depth_fusion/common/error.h"
#include "surface_mesh/surface_mesh_kernels.h"

namespace depth_fusion {
namespace {

constexpr double kCountingShare = 0.3;  // of the time

void report(const MeshProgress& progress, double fraction) {
  if (progress) progress(fraction);
}

// First pass: how many vertices and triangles each block has.
void countBlocks(SurfaceMeshKernels& kernels, const BlockSparseMap& map, std::vector<MeshBlock>& blocks,
                 const MeshProgress& progress) {
  std::vector<MeshBlockArgs> batch;
  for (size_t begin = 0; begin < blocks.size(); begin += batch.size()) {
    const size_t end = std::min(begin + kernels.limits().blocks, blocks.size());
    batch.clear();
    for (size_t i = begin; i < end; ++i) batch.push_back(blockArgs(map, blocks[i]));
    kernels.classify(batch);
    const auto totals = kernels.totals(batch.size());
    for (size_t i = begin; i < end; ++i) {
      blocks[i].vertices = totals[i - begin].vertices;
      blocks[i].triangles = totals[i - begin].triangles;
    }
    report(progress, kCountingShare * static_cast<double>(end) / static_cast<double>(blocks.size()));
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

// Second pass: the mesh itself. Returns the number of batches.
size_t emitBlocks(SurfaceMeshKernels& kernels, const BlockSparseMap& map,
                  const std::vector<MeshBlock>& blocks, const MeshSize& size, MeshSink& sink,
                  const MeshProgress& progress) {
  MeshBatcher batcher(map, blocks, kernels.limits());
  std::vector<MeshVertex> vertices;
  std::vector<MeshTriangle> triangles;
  size_t batches = 0;
  for (uint64_t emitted = 0; !batcher.done(); ++batches) {
    const MeshBatch batch = batcher.next();
    kernels.classify(batch.blocks);
    kernels.emitVertices(batch, vertices);
    sink.addVertices(vertices.data(), vertices.size());
    kernels.emitTriangles(batch, triangles);
    sink.addTriangles(triangles.data(), triangles.size());
    emitted += batch.vertices;
    const double fraction =
        static_cast<double>(emitted) / static_cast<double>(std::max<uint64_t>(size.vertices, 1));
    report(progress, kCountingShare + (1.0 - kCountingShare) * fraction);
  }
  return batches;
}

}  // namespace

ParameterTable SurfaceMeshParameters::table() {
  return {{"min_certainty", &min_certainty, 0, 255, "certainty (see tsdf_fusion/rule) from which on a voxel counts as known"},
          {"max_batch_blocks", &max_batch_blocks, 8, 65536,
           "blocks extracted at a time; fewer take less memory"}};
}

MeshStatistics exportSurfaceMesh(ComputeContext& compute, BlockSparseMap& map, MeshSink& sink,
                                 SurfaceMeshParameters parameters, const MeshProgress& progress) {
  validate(parameters.table());
  SurfaceMeshKernels kernels(compute, map, parameters.min_certainty,
                             static_cast<size_t>(parameters.max_batch_blocks));
  std::vector<MeshBlock> blocks = mortonOrderedBlocks(map);
  MeshStatistics statistics;
  statistics.blocks = blocks.size();
  statistics.device_bytes = kernels.deviceBytes();
  countBlocks(kernels, map, blocks, progress);
  statistics.size = numberVertices(blocks);
  sink.begin(statistics.size);
  statistics.batches = emitBlocks(kernels, map, blocks, statistics.size, sink, progress);
  sink.finish();
  report(progress, 1.0);
  return statistics;
}

}  // namespace depth_fusion
