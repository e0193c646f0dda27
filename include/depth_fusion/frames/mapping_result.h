// What became of a frame in the map.
#pragma once

#include <cstddef>
#include <string>

#include "depth_fusion/geometry/pose.h"

namespace depth_fusion {

struct FusionResult {
  size_t blocks_requested = 0;
  size_t blocks_allocated = 0;  // less than requested: the pool is full, and the frame fused what fits
  size_t blocks_updated = 0;
  size_t blocks_released = 0;
  size_t points_outside = 0;  // samples of the surface outside of the window: left out

  // The frame left something in the map.
  bool fused() const { return blocks_updated > 0; }
};

struct ColorFusionResult {
  bool fused = false;
  std::string reason;                                     // why not
  Eigen::Array3d exposure_gain = Eigen::Array3d::Ones();  // from the image's blue, green, red to the map's
  Pose T_C_W = Pose::Identity();  // of the colour camera, where its colours fit the map's
};

struct MappingResult {
  FusionResult fusion;
  ColorFusionResult color;
};

}  // namespace depth_fusion
