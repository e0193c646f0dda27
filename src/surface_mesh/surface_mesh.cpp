#include "depth_fusion/surface_mesh/surface_mesh.h"

#include "surface_mesh/mesh_extraction.h"

namespace depth_fusion {

ParameterTable SurfaceMeshParameters::table() {
  return {{"min_certainty", &min_certainty, 0, 255,
           "certainty (see tsdf_fusion/rule) from which on a voxel counts as known"},
          {"max_batch_blocks", &max_batch_blocks, 8, 8192,
           "blocks extracted at a time, if 16 MiB hold so many; fewer take less memory"}};
}

MeshStatistics exportSurfaceMesh(ComputeContext& compute, BlockSparseMap& map, MeshSink& sink,
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
