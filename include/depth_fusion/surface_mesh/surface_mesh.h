// Marching cubes over the block-sparse map.
#pragma once

#include "depth_fusion/map/block_map.h"
#include "depth_fusion/surface_mesh/surface_mesh_parameters.h"
#include "depth_fusion/surface_mesh/triangle_mesh.h"

namespace depth_fusion {

struct MeshStatistics {
  MeshSize size;
  size_t blocks = 0;        // in the map
  size_t batches = 0;       // in which the mesh was emitted
  size_t device_bytes = 0;  // allocated for the export, whatever the size of the map
};

// Extracts the surface between the voxels with a negative and those with a positive distance. A cell emits
// triangles if its eight voxels are known. Cells share their vertices across blocks and batches, so the mesh
// has no cracks, and closed surfaces are watertight. The same map gives the same bytes on the same device.
// The voxels must not change meanwhile. Throws Error if the mesh has more than 2^31 - 1 vertices or the sink
// fails. The vertices have colours if the map has.
MeshStatistics exportSurfaceMesh(ComputeContext& compute, BlockMap& map, MeshSink& sink,
                                 SurfaceMeshParameters parameters = {});

}  // namespace depth_fusion
