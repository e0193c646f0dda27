// The surface of some of the map's blocks.
#pragma once

#include "depth_fusion/surface_mesh/triangle_mesh.h"
#include "surface_mesh/mesh_batches.h"
#include "surface_mesh/surface_mesh_kernels.h"

namespace depth_fusion {

// Sends the surface of the blocks, which are in Morton order, to the sink; lends_only blocks send their
// vertices but no triangles. Leaves out of the list the blocks without any, and numbers the vertices of the
// others. Returns the number of batches. `size` says what was sent.
size_t extractBlocks(SurfaceMeshKernels& kernels, const BlockMap& map, std::vector<MeshBlock>& blocks,
                     MeshSink& sink, MeshSize& size);

}  // namespace depth_fusion
