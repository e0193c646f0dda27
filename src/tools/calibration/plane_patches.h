// The planes of a frame, walls and floors and tables, must be flat.
#pragma once

#include <cstdint>

#include "tools/calibration/calibration_view.h"
#include "tools/calibration/residual_map.h"

namespace depth_fusion {

struct PlanesResult {
  int planes = 0;
  NormalEquations equations;
};

// Finds the frame's largest planes. The same seed gives the same ones.
PlanesResult fitPlanes(const CalibrationView& view, uint64_t seed, double cutoff_sigmas, ResidualMap& map);

}  // namespace depth_fusion
