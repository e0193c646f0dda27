#include "map/map_args.h"

#include <cmath>

namespace depth_fusion {

GridArgs gridArgs(const BlockMap& map) {
  const MapParameters& parameters = map.parameters();
  GridArgs args{};
  args.voxel_size_m = parameters.voxel_size_m;
  args.truncation_m = parameters.truncation_m;
  args.blocks_per_axis = parameters.blocks_per_axis;
  const BlockIndex& origin = map.window().origin;
  const BlockIndex wrapped_origin = map.window().wrapped(origin);
  for (int axis = 0; axis < 3; ++axis) {
    args.origin[axis] = origin[axis];
    args.wrapped_origin[axis] = wrapped_origin[axis];
  }
  return args;
}

std::string blockSizeOption(const MapParameters& parameters) {
  return "-DBLOCK_SIZE_LOG2=" + std::to_string(static_cast<int>(std::log2(parameters.block_size)));
}

}  // namespace depth_fusion
