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

// A map of which a part is in memory at a time.
class MeshSource {
 public:
  virtual ~MeshSource() = default;
  // Boxes that have all the blocks between them. If there are several, they are cubes of the same size, a
  // power of two, on a grid from the origin on.
  virtual std::vector<BlockBox> parts() = 0;
  // No block is before it in any axis.
  virtual BlockIndex origin() const = 0;
  // The map that the parts are loaded into.
  virtual BlockMap& map() = 0;
  // Has map() hold a part's blocks, and around them one before and two after in each axis; `done` is the
  // share of the export that is done. Throws to give up.
  virtual void load(const BlockBox& part, double done) = 0;
};

// Extracts the surface between the voxels with a negative and those with a positive distance. A cell emits
// triangles if its eight voxels are known. Cells share their vertices across blocks and batches, so the mesh
// has no cracks, and closed surfaces are watertight. The same map gives the same bytes on the same device.
// The voxels must not change meanwhile. Throws Error if the mesh has more than 2^31 - 1 vertices or the sink
// fails. The vertices have colours if the map has.
MeshStatistics exportSurfaceMesh(ComputeContext& compute, BlockMap& map, MeshSink& sink,
                                 SurfaceMeshParameters parameters = {});

// Extracts the surface of a map that comes part by part. The order of vertices and triangles depends on the
// source's origin.
MeshStatistics exportSurfaceMesh(ComputeContext& compute, MeshSource& source, MeshSink& sink,
                                 SurfaceMeshParameters parameters = {});

}  // namespace depth_fusion
