#include "depth_fusion/map/map_parameters.h"

namespace depth_fusion {

ParameterTable MapParameters::table() {
  return atStartOnly(
      {number("voxel_size_m", &voxel_size_m, 1e-5, 1.0, "edge of a voxel"),
       number("blocks_per_axis", &blocks_per_axis, 1, 1280, "blocks per axis of the window (the paper's N)"),
       number("block_size", &block_size, 4, 32, "voxels per axis of a block, a power of two (the paper's M)"),
       number("truncation_m", &truncation_m, 0.0, 10.0,
              "distance kept on both sides of a surface (the paper's delta); 0 = four voxels"),
       number("pool_mib", &pool_mib, 1, 2047,
              "memory for voxels, allocated once; colour takes twice as much again"),
       flag("color", &color, "true: the map holds colour, where the recording has it")});
}

}  // namespace depth_fusion
