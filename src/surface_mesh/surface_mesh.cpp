#include "depth_fusion/surface_mesh/surface_mesh.h"

#include "surface_mesh/mesh_extraction.h"

namespace depth_fusion {

MeshStatistics exportSurfaceMesh(ComputeContext& compute, BlockMap& map, MeshSink& sink,
                                 SurfaceMeshParameters parameters) {
  validate(parameters.table());
  SurfaceMeshKernels kernels(compute, map, parameters.min_certainty,
                             static_cast<size_t>(parameters.max_batch_blocks));
  std::vector<MeshBlock> blocks = mortonOrderedBlocks(map);
  MeshStatistics statistics;
  statistics.blocks = blocks.size();
  statistics.device_bytes = kernels.deviceBytes();
  statistics.batches = extractBlocks(kernels, map, blocks, sink, statistics.size);
  return statistics;
}

}  // namespace depth_fusion
