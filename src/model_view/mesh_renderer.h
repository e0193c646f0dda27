// The paper's other way to render the scene: marching cubes over the blocks in view, in batches, and their
// triangles rasterised to depth and normals.
#pragma once

#include <optional>
#include <vector>

#include "model_view/mesh_renderer_kernels.h"
#include "surface_mesh/surface_mesh_kernels.h"

namespace depth_fusion {

class MeshRenderer {
 public:
  // Keeps a reference to the map.
  MeshRenderer(ComputeContext& compute, BlockMap& map, const CameraIntrinsics& camera);

  // Fills the view, whose pose is set, with what lies between min_range_m and max_range_m.
  void render(ModelView& view, float min_range_m, float max_range_m, StageTimers& timers);

 private:
  struct Range {
    float min_m, max_m;
  };
  struct Batch {
    int cores = 0, members = 0;
    uint32_t vertices = 0, triangles = 0;
  };

  // Slots of the blocks to polygonise; those near each other are mostly near in the list.
  std::vector<int> listBlocks(const ModelView& view, const Range& range);
  // Draws the blocks from begin to end, in two halves if they are too many for a batch.
  void drawBlocks(const int* begin, const int* end, ModelView& view, const Range& range);
  // Returns nothing if they are too many.
  std::optional<Batch> polygonise(const int* begin, const int* end);
  // Numbers the batch's vertices and triangles, block after block.
  void number(Batch& batch);
  void rasterise(const Batch& batch, ModelView& view, const Range& range);

  ComputeContext& compute_;
  BlockMap& map_;
  SurfaceMeshKernels mesh_;
  MeshRendererKernels kernels_;
  size_t max_cores_;  // of a batch
  DeviceBuffer listed_, count_, places_, members_, firsts_, projected_, drawn_, nearest_;
};

}  // namespace depth_fusion
