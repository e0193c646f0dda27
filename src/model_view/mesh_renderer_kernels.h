// Typed launches of kernels/model_view/list_mesh_blocks.cl and rasterise_triangles.cl.
#pragma once

#include "compute/kernel.h"
#include "depth_fusion/model_view/model_view_renderer.h"
#include "map/slots_in_view.h"

namespace depth_fusion {

class MeshRendererKernels {
 public:
  MeshRendererKernels(ComputeContext& compute, const BlockMap& map);

  void listSurfaceBlocks(BlockMap& map, DeviceBuffer& listed, DeviceBuffer& count, const ModelView& view,
                         float min_range_m, float max_range_m);
  // `count` holds the number of cores before, that of all members after.
  void placeMembers(BlockMap& map, DeviceBuffer& members, DeviceBuffer& places, DeviceBuffer& count,
                    int cores);
  void describeMembers(BlockMap& map, DeviceBuffer& blocks, const DeviceBuffer& members,
                       const DeviceBuffer& places, int cores, int count);
  void numberMembers(DeviceBuffer& blocks, const DeviceBuffer& firsts, int count);
  void clearPlaces(const DeviceBuffer& members, DeviceBuffer& places, int count);

  void projectVertices(DeviceBuffer& projected, const DeviceBuffer& vertices, int count,
                       const ModelView& view);
  // `drawn_count` is 0 before.
  void rasteriseDepth(ModelView& view, DeviceBuffer& nearest, DeviceBuffer& drawn, DeviceBuffer& drawn_count,
                      const DeviceBuffer& projected, const DeviceBuffer& triangles, int count,
                      float min_range_m, float max_range_m);
  void rasteriseNormals(ModelView& view, const DeviceBuffer& nearest, const DeviceBuffer& drawn,
                        const DeviceBuffer& projected, const DeviceBuffer& vertices,
                        const DeviceBuffer& triangles, int count);
  void resolveDepth(ModelView& view, const DeviceBuffer& nearest);

 private:
  SlotsInView in_view_;
  Kernel list_, place_cores_, place_lenders_, describe_, number_, clear_, project_, depth_, normals_,
      resolve_;
};

}  // namespace depth_fusion
