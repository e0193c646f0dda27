#include "depth_fusion/esdf/esdf_parameters.h"

namespace depth_fusion {

ParameterTable EsdfParameters::table() {
  return {
      atStartOnly(number("voxel_size_m", &voxel_size_m, 1e-4, 1.0,
                         "edge of the cells of distances and grids; rounded to a multiple, up to 32, of "
                         "map/voxel_size_m")),
      atStartOnly(number("max_distance_m", &max_distance_m, 0.01, 50.0,
                         "distances are known up to here; 118 cells at most")),
      number("frame_stride", &frame_stride, 1, 1000, "of so many fused frames, free space is taken from one"),
      atStartOnly(number("memory_mib", &memory_mib, 1, 65536,
                         "memory for cells, 9 bytes each; what is beyond stays unknown"))};
}

}  // namespace depth_fusion
