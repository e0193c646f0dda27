#include "depth_fusion/surface_mesh/surface_mesh_parameters.h"

namespace depth_fusion {

ParameterTable SurfaceMeshParameters::table() {
  return {number("min_certainty", &min_certainty, 0, 255,
                 "certainty (see tsdf_fusion/rule) from which on a voxel counts as known"),
          number("max_batch_blocks", &max_batch_blocks, 8, 8192,
                 "blocks extracted at a time, if 16 MiB hold so many; fewer take less memory")};
}

}  // namespace depth_fusion
